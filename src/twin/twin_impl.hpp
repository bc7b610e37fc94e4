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
/// A torque that inputs set, constant between their stamps. Its mean acts over a step.
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
  double mean(Stamp end) const noexcept             ///< mean from the step's beginning to `end` [N.m]
  {
    return from_ == begin_ ? value_ : (sum_ + value_ * toSeconds(end - from_)) / toSeconds(end - begin_);
  }

private:
  double value_{};
  double sum_{};  // integral up to from_ [N.m.s]
  Stamp begin_{};
  Stamp from_{};  // time in this step from which the present value acts
};

/// The parts of the twin and the sequence of its steps.
struct Twin::Impl
{
  Impl(const Parameters& given, const SurfaceSource& surface_source);
  Impl& operator=(const Impl&) = delete;
  static std::unique_ptr<Impl> copyOf(const Impl& other);

  static Stamp delayOf(const Fault& fault) noexcept { return static_cast<Stamp>(std::llround(1e9 * fault.onset)); }

  /// @returns false if the joint has no equilibrium.
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
  SurfaceStages stages;      // if the twin waits for its surfaces
  FaultList surface_faults;  // faults of the requested surface, if the twin does not wait
  std::optional<SurfaceWorker> surface_worker;
  bool surface_awaited{};
  JointStepper stepper;
  ObservedRing observed_ring;
  Stamp step_length;
  std::int64_t instant{};  // number of the present instant since the epoch
  Stamp now{};
  // an input with an earlier stamp is late: the present instant, or the start if that is not a multiple of the step
  Stamp simulated_until{};
  InputQueue queue;
  std::array<Stamp, INPUT_KINDS> in_force_since{};  // stamp of the acting input, by kind
  TwinCounters counters;
  HeldTorque motor_torque;  // commanded torque, limited to the motor's limit
  bool command_clamped{};   // the motor's limit reduced the command
  bool commanded{};         // a command acts that has not timed out
  HeldTorque load_torque;   // limited external torque
  bool load_clamped{};
  double arm_torque{};   // torque of a coupled arm without its inertia [N.m]
  double temperature{};  // received or configured temperature of the drive or its surroundings [degC]
  std::optional<DriveHeat> heat;
  Stamp heat_stamp{};    // end of the losses that it contains
  double heat_booked{};  // part of the dissipated energy that it contains [J]
  double copper_heat{};  // copper losses that it does not contain yet [J]
  bool brake_engaged{};
  bool brake_commanded{};
  Stamp brake_moves{};  // time at which the command is executed
  bool converged{ true };
  JointSensors sensors;
  HealthMonitor monitor;
  SignalMonitor signals;
  Assessor assessor;
  Stamp steps_per_sample;
  static constexpr double CAUSE_SEARCH_TIME = 0.05;  // half the shortest window [s]
  std::size_t searched_per_step;                     // number of signatures
  Stamp steps_per_heat;
  bool watching{};               // indicators are computed from the readings
  Eigen::VectorXd tooth_angles;  // angles at rest [rad]
  Stamp last_failed{};           // instant of the last step that did not converge; initially the earliest stamp
  // instant of the last step that was cut, too long, or with a jump of a tooth; initially the earliest stamp
  Stamp last_doubtful{};

private:
  Impl(const Impl&) = default;  // the parts of the copy refer to the other's model, see copyOf

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
