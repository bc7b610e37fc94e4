// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "harmonic_joint_twin/health/assessment.hpp"
#include "harmonic_joint_twin/health/motion_indicators.hpp"
#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/model/faults/fault_list.hpp"
#include "harmonic_joint_twin/model/lobe_loads.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/sensors/encoder_readings.hpp"
#include "harmonic_joint_twin/statics/tooth_stress.hpp"
#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "harmonic_joint_twin/twin/fault_schedule.hpp"
#include "harmonic_joint_twin/twin/input_queue.hpp"

namespace hjt
{
/// State of the joint at one simulated instant. Angles [rad], speeds [rad/s], torques [N.m], energies [J].
struct JointOutputs
{
  Stamp stamp{};                   ///< simulated instant [ns]
  double motor_angle{};            ///< wave generator, true
  double motor_velocity{};         ///< [rad/s]
  double output_angle{};           ///< circular spline, true
  double output_velocity{};        ///< [rad/s]
  double motor_torque{};           ///< applied, after command timeout and limits
  double load_torque{};            ///< external torque at the output, > 0 resists positive motion
  double temperature{};            ///< of the grease, which sets the friction [degC]
  double housing_temperature{};    ///< [degC]
  double wave_generator_torque{};  ///< of the wave generator on the flexspline: the motor's, less friction and inertia
  double joint_torque{};           ///< of the mesh on the circular spline
  double friction_torque{};        ///< all friction reduced to the motor shaft by power, >= 0
  double torsional_stiffness{};    ///< local, wave generator locked [N.m/rad]
  double energy_residual{};        ///< energy in - stored - dissipated - released since reset [J]
  double dissipated_energy{};      ///< by all friction since reset [J]
  double released_energy{};        ///< stored energy that faults set free when they set in, since reset [J]
  bool brake_engaged{};            ///< the brake holds the motor, but for its play
  bool converged{ true };          ///< false: the ring did not converge and the last good state is held
  std::uint32_t iterations{};      ///< Newton iterations of the last step
  std::uint32_t substeps{};        ///< it was divided into, where it would be too long for the joint's swing; 1 ... 31
  double residual{};               ///< largest out-of-balance force [N]
  double phase_advance{};          ///< of the joint's fastest natural mode in one substep [rad]
};

/// A value for each tooth of the flexspline, sized once by `Twin::makeToothForces`. Signs as in ContactForces.msg.
struct ToothForces
{
  std::vector<double> wave_generator_force;  ///< >= 0 [N]
  std::vector<double> rim_tension;           ///< to the next tooth [N]
  std::vector<double> bending_force;         ///< of the segment to the next tooth [N]
  std::vector<double> mesh_force;            ///< normal to the flank, > 0 leading, < 0 trailing flank [N]
  std::vector<double> tooth_x;               ///< of the tooth point, in the housing's axes [m]
  std::vector<double> tooth_y;               ///< [m]
};

/// State of the solver over some steps, as in Health.msg.
enum class SolverState : std::uint8_t
{
  OK = 0,        ///< every step converged on a short path
  DEGRADED = 1,  ///< steps were cut or too long, or teeth jumped: see TwinCounters
  FAILED = 2     ///< a step found no equilibrium: the last good state was held
};

/// Health indicators beside those in `JointOutputs`; as in Health.msg.
struct HealthReport
{
  MotionIndicators motion;     ///< of the last turns, from the true angles
  LobeLoads lobes;             ///< at the current instant
  SolverState solver_state{};  ///< over the steps since the last call of Twin::health
  double mesh_force_error{};   ///< expected at this speed and load, rms over the loaded teeth: inertia is left out [N]
};

/// Counters since reset, for diagnostics.
struct TwinCounters
{
  std::uint64_t steps{};             ///< steps done
  std::uint64_t solver_failures{};   ///< steps that did not converge: last good state held
  std::uint64_t step_cuts{};         ///< steps that needed a shorter path
  std::uint64_t jumps{};             ///< steps in which a tooth changed its space through a tip
  std::uint64_t coarse_steps{};      ///< steps too long for what the joint does in them
  InputCounters input;               ///< inputs but faults
  FaultCounters faults;              ///< injected faults
  std::uint64_t torque_clamped{};    ///< steps on which the command exceeded motor.torque_limit
  std::uint64_t load_clamped{};      ///< steps on which the load exceeded output.load_torque_limit
  std::uint64_t overloads{};         ///< steps on which the joint's torque exceeded output.torque_limit
  std::uint64_t speed_limited{};     ///< steps on which the drive held torque back at motor.speed_limit
  std::uint64_t command_timeouts{};  ///< times the command ran into input.command_timeout
};

/// The joint twin: commanded torques in, encoder angles, tooth forces and health out. Knows no ROS.
///
/// Time is the time of the messages: instants are whole multiples of the solver step, so that the same stamped inputs
/// give the same numbers live, replayed and offline, in one go or in chunks.
/// After construction no member throws or allocates unless stated. Const members never change the
/// simulation; between two steps several threads may call them at once.
class Twin
{
public:
  /// Inserts the wave generator (some milliseconds). With solver.scene = auto also builds the response surface of the
  /// drive with the faults it starts with (seconds) or takes it from the cache, unless that is to be done beside the
  /// running twin.
  /// @throws ParameterError if the parameters, or the faults that the twin starts with, have no equilibrium.
  explicit Twin(const Parameters& parameters, const SurfaceSource& surface_source = {});
  ~Twin();
  Twin(Twin&&) noexcept;
  Twin& operator=(Twin&&) noexcept;
  /// The same instant, with what waits and what was learned: with the same inputs both go on with the same bits. Shares
  /// the response surfaces; one that is being built in the background the copy obtains in a thread of its own. Both
  /// allocate, and the copy once more in its first steps.
  Twin(const Twin& other);
  Twin& operator=(const Twin& other);

  const Parameters& parameters() const noexcept;  ///< those of the construction, without injected faults

  /// Restarts at rest, zero angles, at the first instant not before `stamp`, with the configured faults; forgets
  /// inputs, other faults and counters. False: the stamp is beyond +-MAX_STAMP, nothing was done.
  bool reset(Stamp stamp) noexcept;

  /// Queues stamped inputs; not finite ones are refused and counted. An input acts from the first instant not before
  /// its stamp; one that comes too late is counted and acts at once, unless a newer one of its kind is in force.
  /// Torques [N.m], of the load > 0 resists positive motion; the temperature, of the drive or with thermal.model =
  /// two_nodes of its surroundings, is kept within its range [degC].
  void commandMotorTorque(Stamp stamp, double torque) noexcept { push({ stamp, InputKind::MOTOR_TORQUE, torque }); }
  void commandLoadTorque(Stamp stamp, double torque) noexcept { push({ stamp, InputKind::LOAD_TORQUE, torque }); }
  void commandBrake(Stamp stamp, bool engaged) noexcept { push({ stamp, InputKind::BRAKE, engaged ? 1.0 : 0.0 }); }
  void setTemperature(Stamp stamp, double degrees) noexcept { push({ stamp, InputKind::TEMPERATURE, degrees }); }

  /// Queues a fault, which sets in `fault.onset` after the stamp, or is taken away (severity 0), like an input; one
  /// that is not valid, or whose stamp is beyond +-MAX_STAMP, is refused and counted. While any is active all teeth are
  /// solved at every step.
  void injectFault(Stamp stamp, const Fault& fault) noexcept;
  const FaultList& activeFaults() const noexcept;  ///< faults in force at the current instant

  void push(const Input& input) noexcept;      ///< queues one input, by `input.kind`
  void push(const TwinInput& input) noexcept;  ///< the same, or `injectFault`

  /// The arm around the joint, from the next step on and until the next call: its inertia at the output in place of
  /// output.load_inertia [kg.m^2], >= 0, and its torque on the output beside that and the load torque, > 0 resists
  /// positive motion [N.m]. Both finite. A reset settles under that torque.
  void coupleArm(double inertia, double torque) noexcept;
  double linkTorque() const noexcept;  ///< of gear and friction on the output, as load and arm feel it [N.m]
  /// To load and arm, since reset: work on them and the output's kinetic energy [J].
  double deliveredEnergy() const noexcept;

  /// Advances by one solver step if the next instant is not after `until`. False: nothing was done.
  bool step(Stamp until) noexcept;

  Stamp stamp() const noexcept;       ///< current instant [ns]
  Stamp stepLength() const noexcept;  ///< [ns]

  JointOutputs outputs() const noexcept;          ///< true state at the current instant
  EncoderReadings encoders() const noexcept;      ///< readings of the sensors, with their errors
  double motorTorqueReading() const noexcept;     ///< as the drive estimates it from its current [N.m]
  const TwinCounters& counters() const noexcept;  ///< since the last reset
  bool onSurface() const noexcept;  ///< the current instant comes from the response surface, not from all teeth

  ToothForces makeToothForces() const;  ///< allocates: call once
  /// Fills the arrays at the current instant; on the response surface this solves a full ring of its own. False: that
  /// found no equilibrium and the arrays stay as they were.
  bool toothForces(ToothForces& forces) noexcept;
  /// The same for the stress of the flexspline; `stress`: sized for its teeth.
  bool toothStress(ToothStress& stress) noexcept;
  /// At the current instant. The solver's state is that of the steps after `since` [ns]; of all since the reset if
  /// `since` is not before the current instant.
  HealthReport health(Stamp since = std::numeric_limits<Stamp>::min()) const noexcept;

  /// Whether indicators and assessment are made of the sensors' readings; off at first. What was learned goes with
  /// `reset`.
  void watchSignals(bool on) noexcept;
  bool watchesSignals() const noexcept;  ///< as set by watchSignals
  /// From the next window on, the indicators have the bearing's lines where it slips, as those of a recording. For runs
  /// that are not in a loop: it keeps every sample of a window, and steps allocate.
  void seekBearingSlip();
  const SignalIndicators& signalIndicators() const noexcept;  ///< of the last window
  /// Of the last window. If it is in alarm, from 50 ms after its end on: the search for its cause takes that long.
  const Assessment& assessment() const noexcept;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace hjt
