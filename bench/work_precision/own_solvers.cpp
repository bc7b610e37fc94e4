// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/work_precision/follow.hpp"
#include "bench/work_precision/solvers.hpp"
#include "studies/ring_stepper.hpp"

namespace hjt
{
namespace
{
/// A method of the package, at a fixed step, a whole number of them to a sample, or by a tolerance.
class OwnStepper : public Integrator
{
public:
  /// One of `step` [s] and `tolerance` [m] is 0.
  OwnStepper(const Problem& problem, RingMethod method, double step, double tolerance, double force_tolerance)
    : step_(step), ring_(problem.ring()), motion_(ring_.coordinates()), state_(ring_.states())
  {
    SolverParameters solver = problem.parameters->solver;
    solver.force_tolerance = std::max(force_tolerance, problem.force_floor);
    stepper_ = makeRingStepper(method, ring_, solver, tolerance);
    motion_.q = problem.q;
    motion_.v = problem.v;
  }

  void enter(const Phase& phase, double /*time*/) override { ring_.setWave(phase.wave); }

  bool advance(double due, double /*end*/, double& time) override
  {
    const long steps = step_ == 0.0 ? 1 : std::lround(std::ceil((due - time) / step_ - 1e-9));
    for (long k = 0; k < steps; ++k)
    {
      if (!stepper_->step(motion_, (due - time) / static_cast<double>(steps)))
      {
        time = motion_.time;
        return false;
      }
    }
    motion_.time = due;
    time = due;
    return true;
  }

  const double* at(double /*time*/) override
  {
    state_ << motion_.q, motion_.v;
    return state_.data();
  }

  void count(Run& run) override
  {
    const StepCounts& counts = stepper_->counts();
    run.steps = counts.steps;
    run.force_evaluations = counts.force_evaluations;
    run.factorisations = counts.factorisations;
    run.rejections = counts.halvings + counts.rejections;
  }

private:
  double step_;
  DynamicRing ring_;
  std::unique_ptr<RingStepper> stepper_;
  RingMotion motion_;
  Eigen::VectorXd state_;
};

Contender byTolerance(const Problem& problem, const char* solver, RingMethod method, double tolerance)
{
  // Stages are solved to a fraction of what the step itself may leave: 0.01 N are 0.1 nm on a tooth's contact.
  const double force_tolerance = std::min(1e-2, 1e4 * tolerance);
  return { solver, "tol = " + text("%.0e m", tolerance),
           [=, &problem](double limit)
           {
             OwnStepper stepper(problem, method, 0.0, tolerance, force_tolerance);
             return follow(problem, stepper, limit);
           } };
}
}  // namespace

Contender fixedStep(const Problem& problem, const std::string& solver, RingMethod method, double step,
                    double force_tolerance)
{
  return { solver, "h = " + text("%.3g us", 1e6 * step),
           [=, &problem](double limit)
           {
             OwnStepper stepper(problem, method, step, 0.0, force_tolerance);
             return follow(problem, stepper, limit);
           } };
}

std::vector<Contender> ownContenders(const Problem& problem)
{
  std::vector<Contender> contenders;
  for (const double tolerance : { 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 1e-9, 1e-10 })
  {
    contenders.push_back(byTolerance(problem, "ours, TR-BDF2", RingMethod::TR_BDF2, tolerance));
  }
  for (const double tolerance : { 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12 })
  {
    contenders.push_back(byTolerance(problem, "ours, ESDIRK4", RingMethod::ESDIRK4, tolerance));
  }
  contenders.push_back(fixedStep(problem, "thesis: implicit Euler", RingMethod::IMPLICIT_EULER, 1e-5, 1e-3));
  return contenders;
}

std::vector<Contender> references(const Problem& problem)
{
  const double duration = problem.duration();
  return { fixedStep(problem, "RK4", RingMethod::RUNGE_KUTTA4, std::min(duration / 4e5, 0.7 / problem.fastest), 0.0),
           fixedStep(problem, "ESDIRK4", RingMethod::ESDIRK4, duration / 2e5, 0.0) };
}
}  // namespace hjt
