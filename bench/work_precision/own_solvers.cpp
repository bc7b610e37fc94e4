// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "bench/work_precision/solvers.hpp"
#include "harmonic_joint_twin/solver/ring_method.hpp"

namespace hjt
{
namespace
{
std::string text(const char* format, double value)
{
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

/// A method of the package at a fixed step, a whole number of them to a sample.
Run march(const Problem& problem, RingMethod method, double step, double force_tolerance, double limit)
{
  DynamicRing ring = problem.ring();
  SolverParameters solver = problem.parameters->solver;
  solver.force_tolerance = std::max(force_tolerance, problem.force_floor);
  const std::unique_ptr<RingStepper> stepper = makeRingStepper(method, ring, solver);
  RingMotion motion(ring.coordinates());
  motion.q = problem.q;
  motion.v = problem.v;
  Recorder recorder(problem);
  Eigen::VectorXd state(ring.states());
  const long per_sample = std::lround(std::ceil(problem.sample_period / step - 1e-9));
  const double length = problem.sample_period / static_cast<double>(per_sample);
  auto phase = problem.phases.begin();
  Run run;
  const Stopwatch watch;
  while (!recorder.done())
  {
    const double due = recorder.due();
    if (due > phase->end * (1.0 + 1e-12))
    {
      ++phase;
    }
    ring.setWave(phase->wave);
    for (long k = 0; k < per_sample; ++k)
    {
      if (!stepper->step(motion, length))
      {
        run.failure = "step failed at " + text("%.3g s", motion.time);
        return run;
      }
    }
    if (watch.elapsed() > limit)
    {
      run.failure = "gave up at " + text("%.3g s", motion.time);
      return run;
    }
    motion.time = due;
    state << motion.q, motion.v;
    recorder.add(state.data());
  }
  run.time = watch.elapsed();
  const StepCounts& counts = stepper->counts();
  run.steps = counts.steps;
  run.force_evaluations = counts.force_evaluations;
  run.jacobians = counts.factorisations;
  run.factorisations = counts.factorisations;
  run.rejections = counts.halvings;
  run.series = recorder.series();
  return run;
}

Contender fixedStep(const char* solver, RingMethod method, double step, double force_tolerance)
{
  return { solver, "h = " + text("%.3g us", 1e6 * step),
           [=](const Problem& problem, double limit) { return march(problem, method, step, force_tolerance, limit); } };
}

/// Dormand and Prince's method, its step controlled by odeint.
Run dopri5(const Problem& problem, double tolerance, double limit)
{
  using namespace boost::numeric::odeint;
  using State = std::vector<double>;
  DynamicRing ring = problem.ring();
  const Eigen::VectorXd scale = problem.scale();
  State state(static_cast<std::size_t>(ring.states()));
  State scaled(state.size());
  State rates(state.size());
  const auto n = static_cast<Eigen::Index>(state.size());
  Eigen::Map<Eigen::VectorXd>(state.data(), n) << problem.q, problem.v;
  const Eigen::VectorXd start = Eigen::Map<Eigen::VectorXd>(state.data(), n);
  std::fill(scaled.begin(), scaled.end(), 0.0);
  Run run;
  const auto unscale = [&](const State& from)
  {
    Eigen::Map<Eigen::VectorXd>(state.data(), n) =
        start + scale.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(from.data(), n));
  };
  const auto system = [&](const State& from, State& derivative, double time)
  {
    unscale(from);
    ring.rates(state.data(), time, rates.data());
    Eigen::Map<Eigen::VectorXd>(derivative.data(), n) =
        Eigen::Map<const Eigen::VectorXd>(rates.data(), n).cwiseQuotient(scale);
    ++run.force_evaluations;
  };
  auto stepper = make_controlled(tolerance, 0.0, runge_kutta_dopri5<State>());
  Recorder recorder(problem);
  auto phase = problem.phases.begin();
  double time = 0.0;
  double step = 1e-8;
  const Stopwatch watch;
  while (!recorder.done())
  {
    const double due = recorder.due();
    if (due > phase->end * (1.0 + 1e-12))
    {
      ++phase;
    }
    ring.setWave(phase->wave);
    stepper.reset();
    while (time < due * (1.0 - 1e-14))
    {
      double next = std::min(step, due - time);
      const bool cut = next < step;
      if (stepper.try_step(system, scaled, time, next) == success)
      {
        ++run.steps;
        unscale(scaled);
        ring.pairTeeth(Eigen::Map<const Eigen::VectorXd>(state.data(), n / 2), time);
        step = cut ? step : next;
      }
      else
      {
        ++run.rejections;
        step = next;
      }
      if (watch.elapsed() > limit || !(step > 1e-13))
      {
        run.failure = "gave up at " + text("%.3g s", time);
        return run;
      }
    }
    time = due;
    recorder.add(state.data());
  }
  run.time = watch.elapsed();
  run.series = recorder.series();
  return run;
}
}  // namespace

std::vector<Contender> ownContenders()
{
  // Stages are solved to a fraction of what the step itself leaves.
  std::vector<Contender> contenders;
  const double steps[] = { 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6 };
  for (const double step : steps)
  {
    const double tolerance = 1e-2 * std::min(1.0, std::pow(step / 1e-4, 2.0));
    contenders.push_back(fixedStep("ours, ESDIRK4", RingMethod::ESDIRK4, step, tolerance));
  }
  for (const double step : steps)
  {
    const double tolerance = 1e-2 * std::min(1.0, std::pow(step / 1e-4, 2.0));
    contenders.push_back(fixedStep("ours, TR-BDF2", RingMethod::TR_BDF2, step, tolerance));
  }
  contenders.push_back(fixedStep("implicit Euler (thesis' step)", RingMethod::IMPLICIT_EULER, 1e-5, 1e-3));
  return contenders;
}

std::vector<Contender> odeintContenders(const Problem& problem)
{
  std::vector<Contender> contenders;
  // Steps near the limit of stability whatever the error, and many of them: they are given longer than the others.
  constexpr double PATIENCE = 8.0;
  const Contender runge_kutta = fixedStep("odeint RK4", RingMethod::RUNGE_KUTTA4, 2.5 / problem.fastest, 0.0);
  contenders.push_back({ runge_kutta.solver, runge_kutta.setting,
                         [=](const Problem& on, double limit) { return runge_kutta.run(on, PATIENCE * limit); } });
  constexpr double TOLERANCE = 1e-2;
  contenders.push_back({ "odeint dopri5", "tol = " + text("%.0e", TOLERANCE),
                         [=](const Problem& on, double limit) { return dopri5(on, TOLERANCE, PATIENCE * limit); } });
  return contenders;
}

std::vector<Contender> references(const Problem& problem)
{
  const double duration = problem.duration();
  return { fixedStep("RK4", RingMethod::RUNGE_KUTTA4, std::min(duration / 4e5, 0.7 / problem.fastest), 0.0),
           fixedStep("ESDIRK4", RingMethod::ESDIRK4, duration / 2e5, 0.0) };
}
}  // namespace hjt
