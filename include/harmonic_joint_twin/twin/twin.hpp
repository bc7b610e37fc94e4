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
  Stamp stamp{};                 ///< simulated instant [ns]
  double motor_angle{};          ///< true angle of the wave generator
  double motor_velocity{};       ///< true speed of the wave generator
  double output_angle{};         ///< true angle of the circular spline
  double output_velocity{};      ///< true speed of the circular spline
  double motor_torque{};         ///< torque of the motor after command timeout and limits
  double load_torque{};          ///< external torque at the output, > 0 resists positive motion
  double temperature{};          ///< temperature of the grease, which determines the friction [degC]
  double housing_temperature{};  ///< temperature of the housing [degC]
  /// torque of the wave generator on the flexspline: the motor's torque minus friction and inertia
  double wave_generator_torque{};
  double joint_torque{};         ///< torque of the mesh on the circular spline
  double friction_torque{};      ///< torque at the motor shaft with the power of all friction, >= 0
  double torsional_stiffness{};  ///< local torsional stiffness with the wave generator locked [N.m/rad]
  double energy_residual{};      ///< energy since the last reset: supplied - stored - dissipated - released [J]
  double dissipated_energy{};    ///< energy that all friction dissipated since the last reset [J]
  double released_energy{};      ///< stored energy that was lost at the onset of faults since the last reset [J]
  bool brake_engaged{};          ///< whether the brake holds the motor within its play
  bool converged{ true };        ///< false: the ring did not converge, and the last converged state is kept
  std::uint32_t iterations{};    ///< Newton iterations of the last step
  std::uint32_t substeps{};  ///< number of substeps of the last step, more than 1 for short natural periods; 1 ... 31
  double residual{};         ///< largest out-of-balance force [N]
  double phase_advance{};    ///< phase by which the joint's fastest natural mode advances in a substep [rad]
};

/// One value for each tooth of the flexspline. `Twin::makeToothForces` sets the size. Signs are as in
/// ContactForces.msg.
struct ToothForces
{
  std::vector<double> wave_generator_force;  ///< force of the wave generator on the tooth, >= 0 [N]
  std::vector<double> rim_tension;           ///< tension of the rim to the next tooth [N]
  std::vector<double> bending_force;         ///< bending force of the segment to the next tooth [N]
  std::vector<double> mesh_force;  ///< force normal to the flank, > 0 on the leading, < 0 on the trailing flank [N]
  std::vector<double> tooth_x;     ///< x of the tooth point in the axes of the housing [m]
  std::vector<double> tooth_y;     ///< y of the tooth point in the axes of the housing [m]
};

/// State of the solver over several steps, as in Health.msg.
enum class SolverState : std::uint8_t
{
  OK = 0,        ///< every step converged without cuts
  DEGRADED = 1,  ///< some steps were cut or too long, or teeth jumped; see TwinCounters
  FAILED = 2     ///< a step found no equilibrium, and the twin kept the last converged state
};

/// Health indicators that JointOutputs does not contain, as in Health.msg.
struct HealthReport
{
  MotionIndicators motion;     ///< indicators over the last turns, from the true angles
  LobeLoads lobes;             ///< loads of the lobes at the current instant
  SolverState solver_state{};  ///< over the steps since the last call of Twin::health
  /// expected rms error of the mesh forces of loaded teeth at this speed and load, because the ring has no inertia [N]
  double mesh_force_error{};
};

/// Counts since the last reset, for diagnostics.
struct TwinCounters
{
  std::uint64_t steps{};             ///< all steps
  std::uint64_t solver_failures{};   ///< steps that did not converge; the twin kept the last converged state
  std::uint64_t step_cuts{};         ///< steps that needed a shorter path
  std::uint64_t jumps{};             ///< steps in which a tooth changed its space through a tip
  std::uint64_t coarse_steps{};      ///< steps that were too long for the motion of the joint
  InputCounters input;               ///< inputs except faults
  FaultCounters faults;              ///< injected faults
  std::uint64_t torque_clamped{};    ///< steps on which the command exceeded motor.torque_limit
  std::uint64_t load_clamped{};      ///< steps on which the load exceeded output.load_torque_limit
  std::uint64_t overloads{};         ///< steps on which the joint's torque exceeded output.torque_limit
  std::uint64_t speed_limited{};     ///< steps on which the drive held torque back at motor.speed_limit
  std::uint64_t command_timeouts{};  ///< times the command ran into input.command_timeout
};

/// The twin of one joint: commanded torques are its inputs; encoder angles, tooth forces and health are its outputs.
///
/// The time is that of the inputs' stamps. All instants are multiples of the solver's step, so that the same stamped
/// inputs give the same results live, replayed and offline, whatever the calls of `step` are. After construction no
/// member throws or allocates unless its comment says so. Const members do not change the simulation, and several
/// threads may call them at once between two steps.
class Twin
{
public:
  /// Solves the insertion of the wave generator, which takes milliseconds. With solver.scene = auto the constructor
  /// also builds the drive's response surface, which takes seconds, or reads it from the cache; see
  /// SurfaceSource::background.
  /// @throws ParameterError if the parameters, or the faults that are active at the start, have no equilibrium.
  explicit Twin(const Parameters& parameters, const SurfaceSource& surface_source = {});
  ~Twin();
  Twin(Twin&&) noexcept;
  Twin& operator=(Twin&&) noexcept;
  /// Copies the state at the current instant, with waiting inputs and learned references. With the same inputs, copy
  /// and original give bitwise equal results. They share the response surfaces, but the copy builds an unfinished
  /// surface in a thread of its own. Construction and assignment allocate, and so do the first steps of the copy.
  Twin(const Twin& other);
  Twin& operator=(const Twin& other);

  const Parameters& parameters() const noexcept;  ///< parameters of the construction, without injected faults

  /// Restarts at rest with zero angles and the configured faults, at the first instant not before `stamp`. Discards all
  /// inputs, injected faults and counts. @returns false and changes nothing if the stamp is beyond +-MAX_STAMP.
  bool reset(Stamp stamp) noexcept;

  /// Queue a stamped input; the twin refuses and counts values that are not finite. An input acts from the first
  /// instant not before its stamp. A late input is counted and acts at once, unless a newer input of its kind already
  /// acts. Torques [N.m]; a load torque > 0 resists positive motion. The temperature is that of the drive, or of its
  /// surroundings if thermal.model is two_nodes; the twin limits it to its range [degC].
  void commandMotorTorque(Stamp stamp, double torque) noexcept { push({ stamp, InputKind::MOTOR_TORQUE, torque }); }
  void commandLoadTorque(Stamp stamp, double torque) noexcept { push({ stamp, InputKind::LOAD_TORQUE, torque }); }
  void commandBrake(Stamp stamp, bool engaged) noexcept { push({ stamp, InputKind::BRAKE, engaged ? 1.0 : 0.0 }); }
  void setTemperature(Stamp stamp, double degrees) noexcept { push({ stamp, InputKind::TEMPERATURE, degrees }); }

  /// Queues a fault, which sets in `fault.onset` after the stamp; severity 0 removes the fault of this kind and place.
  /// The twin refuses and counts an invalid fault, or a stamp beyond +-MAX_STAMP. While a fault is active, the twin
  /// solves all teeth at every step.
  void injectFault(Stamp stamp, const Fault& fault) noexcept;
  const FaultList& activeFaults() const noexcept;  ///< faults that are active at the current instant

  void push(const Input& input) noexcept;      ///< queues one input of the kind `input.kind`
  void push(const TwinInput& input) noexcept;  ///< queues an input or injects a fault

  /// Couples the arm to the joint from the next step until the next call. `inertia` replaces output.load_inertia
  /// [kg.m^2], >= 0. `torque` acts on the output in addition to the load torque, > 0 resists positive motion [N.m].
  /// Both are finite. A reset settles under this torque.
  void coupleArm(double inertia, double torque) noexcept;
  double linkTorque() const noexcept;  ///< torque of gear and friction on the output, which load and arm receive [N.m]
  /// Work on load and arm plus kinetic energy of the output since the last reset [J].
  double deliveredEnergy() const noexcept;

  /// Advances by one solver step if the next instant is not after `until`. @returns false if it did not step.
  bool step(Stamp until) noexcept;

  Stamp stamp() const noexcept;       ///< current instant [ns]
  Stamp stepLength() const noexcept;  ///< length of a solver step [ns]

  JointOutputs outputs() const noexcept;       ///< true state at the current instant
  EncoderReadings encoders() const noexcept;   ///< readings of the encoders, with sensor errors
  double motorTorqueReading() const noexcept;  ///< torque of the motor as the drive estimates it from the current [N.m]
  const TwinCounters& counters() const noexcept;  ///< counts since the last reset
  /// whether the current instant was computed from the response surface instead of all teeth
  bool onSurface() const noexcept;

  ToothForces makeToothForces() const;  ///< arrays of the right size; allocates, so call it once
  /// Fills the arrays at the current instant. On the response surface this solves a separate full ring. @returns false
  /// and leaves the arrays unchanged if that ring has no equilibrium.
  bool toothForces(ToothForces& forces) noexcept;
  /// Does the same for the stresses of the flexspline; `stress` must have the size of its number of teeth.
  bool toothStress(ToothStress& stress) noexcept;
  /// Health at the current instant. The state of the solver covers the steps after `since` [ns], or all steps since the
  /// last reset if `since` is not before the current instant.
  HealthReport health(Stamp since = std::numeric_limits<Stamp>::min()) const noexcept;

  /// Switches the computation of indicators and assessment from the sensors' readings; initially off. `reset` discards
  /// what was learned.
  void watchSignals(bool on) noexcept;
  bool watchesSignals() const noexcept;  ///< whether watchSignals switched it on
  /// From the next window on, computes the lines of the bearing with its slip, as for a recording. Not for a control
  /// loop: each window stores all its samples, and steps allocate.
  void seekBearingSlip();
  const SignalIndicators& signalIndicators() const noexcept;  ///< indicators of the last window
  /// Assessment of the last window. An alarm is assessed 50 ms after the end of its window, when the search for its
  /// cause has finished.
  const Assessment& assessment() const noexcept;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace hjt
