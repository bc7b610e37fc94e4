// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "elements/drive_heat.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "health/health_monitor.hpp"
#include "health/signal_monitor.hpp"
#include "model/faults/joint_faults.hpp"
#include "sensors/joint_sensors.hpp"
#include "solver/joint_stepper.hpp"
#include "twin/tooth_forces.hpp"
#include "twin/twin_surfaces.hpp"

namespace hjt
{
/// Torque that is constant from the stamp of an input to that of the next. In a step the mean of the torque acts.
class HeldTorque
{
public:
  void begin(Stamp step) noexcept
  {
    from_ = begin_ = step;
    sum_ = 0.0;
  }
  void set(double value, Stamp at) noexcept
  {
    sum_ += value_ * toSeconds(at - from_);
    from_ = at;
    value_ = value;
  }
  double value() const noexcept { return value_; }  ///< present value [N.m]
  double mean(Stamp end) const noexcept             ///< mean from the beginning of the step to `end` [N.m]
  {
    return from_ == begin_ ? value_ : (sum_ + value_ * toSeconds(end - from_)) / toSeconds(end - begin_);
  }

private:
  double value_{};
  double sum_{};  // integral over the time from begin_ to from_ [N.m.s]
  Stamp begin_{};
  Stamp from_{};  // time in the step from which the present value acts [ns]
};

/// Parts of a twin, and the actions of a step.
struct Twin::Impl
{
  Impl(const Parameters& given, const SurfaceSource& surface_source);
  Impl& operator=(const Impl&) = delete;
  static std::unique_ptr<Impl> copyOf(const Impl& other);

  static Stamp delayOf(const Fault& fault) noexcept { return static_cast<Stamp>(std::llround(1e9 * fault.onset)); }

  /// See Twin::reset. @returns false if the joint has no equilibrium.
  bool reset(Stamp stamp) noexcept;
  const JointModel& model() const noexcept { return faults.model(); }
  void step() noexcept;
  LobeLoads lobes() const noexcept;
  SolverState solverState(Stamp since) const noexcept;
  JointOutputs outputs() const noexcept;

  Parameters parameters;
  JointFaults faults;
  FaultList active;
  FaultSchedule waiting;
  SurfaceStages stages;      // surfaces that were built before the start
  FaultList surface_faults;  // faults of the surface that surface_worker was last asked for
  std::optional<SurfaceWorker> surface_worker;
  bool surface_awaited{};
  JointStepper stepper;
  ObservedRing observed_ring;
  Stamp step_length;
  std::int64_t instant{};  // number of the present instant: time of the instant / step_length
  Stamp now{};
  // Present instant, or the stamp of the reset. An input with an earlier stamp is late.
  Stamp simulated_until{};
  InputQueue queue;
  std::array<Stamp, INPUT_KINDS> in_force_since{};  // stamp of the acting input of each kind
  TwinCounters counters;
  HeldTorque motor_torque;  // commanded torque, clamped to motor.torque_limit
  bool command_clamped{};   // whether motor.torque_limit reduced the command
  bool commanded{};         // whether a command acts that has not timed out
  HeldTorque load_torque;   // external torque, clamped to output.load_torque_limit
  bool load_clamped{};
  double arm_torque{};   // torque of a coupled arm, see Twin::coupleArm [N.m]
  double temperature{};  // received or configured temperature of the drive or its surroundings [degC]
  std::optional<DriveHeat> heat;
  Stamp heat_stamp{};    // time up to which `heat` contains the losses [ns]
  double heat_booked{};  // dissipated energy that `heat` contains [J]
  double copper_heat{};  // copper losses that `heat` does not yet contain [J]
  bool brake_engaged{};
  bool brake_commanded{};
  Stamp brake_moves{};  // time at which the brake executes the last command [ns]
  bool converged{ true };
  JointSensors sensors;
  HealthMonitor monitor;
  SignalMonitor signals;
  Assessor assessor;
  Stamp steps_per_sample;
  static constexpr double CAUSE_SEARCH_TIME = 0.05;  // duration of a search: half the shortest window [s]
  std::size_t searched_per_step;                     // number of signatures that a search compares in a step
  Stamp steps_per_heat;
  bool watching{};               // see Twin::watchSignals
  Eigen::VectorXd tooth_angles;  // angle of each tooth at rest [rad]
  Stamp last_failed{};           // instant of the last step that did not converge; initially the earliest stamp
  // instant of the last step that was cut or too long, or in which a tooth jumped; initially the earliest stamp
  Stamp last_doubtful{};

private:
  Impl(const Impl&) = default;  // leaves pointers to the model of the original, see copyOf

  void prepareSurface(const SurfaceSource& source);
  const ResponseSurface* presentSurface() const noexcept;
  bool useSurface() noexcept;
  void scheduleConfigured(Stamp stamp) noexcept;
  bool takeFaults() noexcept;
  void takeInputs(Stamp begin) noexcept;
  void takeInput(const Input& input, Stamp at) noexcept;
  bool takeSurface() noexcept;
  void timeOutCommand(Stamp begin) noexcept;
  double greaseTemperature() const noexcept;
  double housingTemperature() const noexcept;
  void resetHeat() noexcept;
  void takeHeat(double motor_torque) noexcept;
  void moveBrake(Stamp begin) noexcept;
  void observe() noexcept;
  void takeReadings() noexcept;
};
}  // namespace hjt
