// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "bench/work_precision/follow.hpp"
#include "bench/work_precision/solvers.hpp"
#include "studies/ring_stepper.hpp"

namespace hjt
{
namespace
{
using namespace boost::numeric::odeint;

/// Dormand and Prince's method of order 5, its step controlled by odeint; states scaled, so that one tolerance serves
/// all.
class Dopri5 : public Integrator
{
public:
  Dopri5(const Problem& problem, double tolerance)
    : ring_(problem.ring())
    , scale_(problem.scale())
    , start_(ring_.states())
    , state_(ring_.states())
    , rates_(ring_.states())
    , scaled_(static_cast<std::size_t>(ring_.states()), 0.0)
    , stepper_(make_controlled(tolerance, 0.0, runge_kutta_dopri5<State>()))
  {
    start_ << problem.q, problem.v;
  }

  void enter(const Phase& phase, double /*time*/) override
  {
    ring_.setWave(phase.wave);
    stepper_.reset();
  }

  bool advance(double due, double /*end*/, double& time) override
  {
    constexpr double SHORTEST = 1e-13;  // [s]
    constexpr double SAME = 1.0 - 1e-14;
    const auto system = [&](const State& from, State& derivative, double at)
    {
      unscale(from);
      ring_.rates(state_.data(), at, rates_.data());
      Eigen::Map<Eigen::VectorXd>(derivative.data(), rates_.size()) = rates_.cwiseQuotient(scale_);
      ++evaluations_;
    };
    double next = std::min(step_, due - time);
    const bool cut = next < step_;
    if (stepper_.try_step(system, scaled_, time, next) == success)
    {
      ++steps_;
      unscale(scaled_);
      ring_.pairTeeth(state_.head(ring_.coordinates()), time);
      step_ = cut ? step_ : next;
      time = time >= due * SAME ? due : time;
    }
    else
    {
      ++rejections_;
      step_ = next;
    }
    return step_ > SHORTEST;
  }

  const double* at(double /*time*/) override { return state_.data(); }

  void count(Run& run) override
  {
    run.steps = steps_;
    run.force_evaluations = evaluations_;
    run.rejections = rejections_;
  }

private:
  using State = std::vector<double>;

  void unscale(const State& from)
  {
    state_ = start_ + scale_.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(from.data(), scale_.size()));
  }

  DynamicRing ring_;
  Eigen::VectorXd scale_;
  Eigen::VectorXd start_;
  Eigen::VectorXd state_;
  Eigen::VectorXd rates_;
  State scaled_;
  result_of::make_controlled<runge_kutta_dopri5<State>>::type stepper_;
  double step_{ 1e-8 };  // [s]
  long steps_{};
  long evaluations_{};
  long rejections_{};
};
}  // namespace

std::vector<Contender> odeintContenders(const Problem& problem)
{
  // Steps at the limit of stability and a half and a quarter of that.
  std::vector<Contender> contenders;
  for (const double part : { 1.0, 0.5, 0.25 })
  {
    const Contender runge_kutta =
        fixedStep(problem, "odeint RK4", RingMethod::RUNGE_KUTTA4, part * 2.5 / problem.fastest, 0.0);
    contenders.push_back({ runge_kutta.solver, runge_kutta.setting,
                           [=](double limit) { return runge_kutta.run(EXPLICIT_PATIENCE * limit); } });
  }
  for (const double tolerance : { 1e-1, 1e-2, 1e-3 })
  {
    contenders.push_back({ "odeint dopri5", "tol = " + text("%.0e", tolerance),
                           [=, &problem](double limit)
                           {
                             Dopri5 integrator(problem, tolerance);
                             return follow(problem, integrator, EXPLICIT_PATIENCE * limit);
                           } });
  }
  return contenders;
}
}  // namespace hjt
