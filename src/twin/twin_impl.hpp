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
/// A torque that inputs set, held from stamp to stamp. Over a step its mean acts.
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
  double value() const noexcept { return value_; }  ///< in force at last [N.m]
  double mean(Stamp end) const noexcept             ///< from the step's begin [N.m]
  {
    return from_ == begin_ ? value_ : (sum_ + value_ * toSeconds(end - from_)) / toSeconds(end - begin_);
  }

private:
  double value_{};
  double sum_{};  // up to from_ [N.m.s]
  Stamp begin_{};
  Stamp from_{};  // in force since then, of this step
};

/// The twin's parts and what happens in one of its steps.
struct Twin::Impl
{
  Impl(const Parameters& given, const SurfaceSource& surface_source);
  Impl& operator=(const Impl&) = delete;
  static std::unique_ptr<Impl> copyOf(const Impl& other);

  static Stamp delayOf(const Fault& fault) noexcept { return static_cast<Stamp>(std::llround(1e9 * fault.onset)); }

  /// @returns false if the joint found no equilibrium.
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
  SurfaceStages stages;      // where the twin waits for its surfaces
  FaultList surface_faults;  // of the surface requested, where it does not
  std::optional<SurfaceWorker> surface_worker;
  bool surface_awaited{};
  JointStepper stepper;
  ObservedRing observed_ring;
  Stamp step_length;
  std::int64_t instant{};  // number of the present one, from the epoch on
  Stamp now{};
  Stamp simulated_until{};  // an input with an earlier stamp is late: now, or the start if that is not on the grid
  InputQueue queue;
  std::array<Stamp, INPUT_KINDS> in_force_since{};  // stamp of the input in force, by kind
  TwinCounters counters;
  HeldTorque motor_torque;  // as commanded, within the motor's limit
  bool command_clamped{};   // by that limit
  bool commanded{};         // a command is in force, not timed out
  HeldTorque load_torque;   // clamped
  bool load_clamped{};
  double arm_torque{};   // of an arm around the joint, beside its inertia [N.m]
  double temperature{};  // received or configured: of the drive, or of its surroundings [degC]
  std::optional<DriveHeat> heat;
  Stamp heat_stamp{};    // up to where the losses are in it
  double heat_booked{};  // of the dissipated energy [J]
  double copper_heat{};  // not yet in it [J]
  bool brake_engaged{};
  bool brake_commanded{};
  Stamp brake_moves{};  // when the command is carried out
  bool converged{ true };
  JointSensors sensors;
  HealthMonitor monitor;
  SignalMonitor signals;
  Assessor assessor;
  Stamp steps_per_sample;
  static constexpr double CAUSE_SEARCH_TIME = 0.05;  // half the shortest window [s]
  std::size_t searched_per_step;                     // signatures
  Stamp steps_per_heat;
  bool watching{};               // indicators are made of the readings
  Eigen::VectorXd tooth_angles;  // at rest [rad]
  Stamp last_failed{};           // instant of the last step that did not converge; before any: the earliest
  Stamp last_doubtful{};         // likewise of one that was cut, too long, or in which a tooth jumped

private:
  Impl(const Impl&) = default;  // its parts refer to the model of the other: copyOf

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
