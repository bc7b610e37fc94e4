// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <utility>

#include "bench/work_precision/follow.hpp"
#include "bench/work_precision/operating.hpp"
#include "twin/tooth_forces.hpp"

namespace hjt
{
constexpr double DURATION = 1.0;        // [s]
constexpr double SAMPLE_PERIOD = 0.01;  // [s]
constexpr double REVERSAL = 0.3;        // the motor's torque changes its sign [s]
constexpr double TORQUE = 0.25;         // [N.m]
constexpr double LOAD = 5.0;            // [N.m]

inline double motorTorque(double time)
{
  return time < REVERSAL ? TORQUE : -TORQUE;
}

/// The joint on its way, with the samples it has left behind.
class Journey
{
public:
  /// Where the ring's forces come from.
  enum class Way
  {
    RING,         ///< it is solved at every step
    TABLE,        ///< torques from the table; the ring is solved for the samples
    TABLE_ANGLES  ///< as before, and of the samples the angles alone are taken
  };

  explicit Journey(const OperatingProblem& problem, Way way = Way::RING)
    : dynamics(problem.model, problem.parameters.solver)
    , way_(way)
    , observed_(problem.model.ring, problem.parameters.solver)
    , samples_(static_cast<int>(DURATION / SAMPLE_PERIOD + 0.5))
    , series_{ Eigen::MatrixXd(samples_, 2), Eigen::MatrixXd(samples_, 2 * teeth()),
               Eigen::MatrixXd(samples_, 2 * teeth()) }
  {
    dynamics.inputs.load_torque = LOAD;
    dynamics.inputs.temperature = problem.parameters.input.temperature;
    if (!dynamics.solveAtRest().ok())
    {
      throw std::runtime_error("operating: no equilibrium to start from");
    }
    x[joint_state::OUTPUT_ANGLE] = dynamics.outputAngle();
    if (way != Way::RING)
    {
      if (!dynamics.useSurface(problem.surface.get()) || !dynamics.placeOnSurface(0.0, dynamics.outputAngle()))
      {
        throw std::runtime_error("operating: not on the table at the start");
      }
    }
  }

  bool done() const { return taken_ == samples_; }
  double due() const { return SAMPLE_PERIOD * (taken_ + 1); }

  /// The state at the time due.
  void sample(const JointState& state)
  {
    (void)dynamics.place(state[joint_state::MOTOR_ANGLE], state[joint_state::OUTPUT_ANGLE]);  // its status is kept
    series_.angles.row(taken_) = state.head<2>();
    const RingEquilibrium* ring = way_ == Way::TABLE_ANGLES ? nullptr : observed_.at(dynamics);
    if (ring != nullptr)
    {
      series_.positions.row(taken_) = ring->shape().points;
      series_.forces.row(taken_) << ring->forces().of<WaveGeneratorContact>().force.transpose(),
          ring->forces().of<ToothMesh>().flank_force.transpose();
    }
    else
    {
      constexpr double NONE = 1e12;
      series_.positions.row(taken_).setConstant(NONE);
      series_.forces.row(taken_).setConstant(NONE);
    }
    ++taken_;
  }

  const Series& series() const { return series_; }

  JointDynamics dynamics;
  JointState x{ JointState::Zero() };

private:
  int teeth() const { return dynamics.ring().shape().teeth(); }

  Way way_;
  ObservedRing observed_;
  int samples_;
  Series series_;
  int taken_{};
};
using Way = Journey::Way;

/// Samples that `advance` reaches one after the other; it steps up to a time and gives false if it fails.
template <class Advance>
Run travel(Journey& journey, double limit, Advance&& advance)
{
  Run run;
  const Stopwatch watch;
  while (!journey.done() && run.failure.empty())
  {
    const double due = journey.due();
    journey.dynamics.inputs.motor_torque = motorTorque(due - 0.5 * SAMPLE_PERIOD);
    const bool good = advance(due, run) && journey.dynamics.status.ok();
    run.time = watch.elapsed();
    if (!good || run.time > limit)
    {
      run.failure = (good ? "gave up at " : "failed at ") + text("%.3g s", due);
    }
    journey.sample(journey.x);
  }
  run.reached = journey.due();
  run.series = journey.series();
  return run;
}

inline int stepsToASample(double step)
{
  return static_cast<int>(std::lround(SAMPLE_PERIOD / step));
}
}  // namespace hjt
