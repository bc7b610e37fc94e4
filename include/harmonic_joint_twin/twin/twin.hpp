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
/// State of the joint at one simulated instant.
struct JointOutputs
{
  Stamp stamp{};                 ///< simulated instant [ns]
  double motor_angle{};          ///< true angle of the wave generator [rad]
  double motor_velocity{};       ///< true speed of the wave generator [rad/s]
  double output_angle{};         ///< true angle of the circular spline [rad]
  double output_velocity{};      ///< true speed of the circular spline [rad/s]
  double motor_torque{};         ///< torque of the motor after timeout, limits and lag of the current loop [N.m]
  double load_torque{};          ///< external torque at the output, > 0 resists positive motion [N.m]
  double temperature{};          ///< temperature of the grease, which determines the friction [degC]
  double housing_temperature{};  ///< temperature of the housing [degC]
  /// torque of the wave generator on the flexspline: motor torque - friction - inertia torque [N.m]
  double wave_generator_torque{};
  double joint_torque{};         ///< torque of the mesh on the circular spline [N.m]
  double friction_torque{};      ///< torque at the motor shaft that has the power of all friction, >= 0 [N.m]
  double torsional_stiffness{};  ///< local torsional stiffness with the wave generator locked [N.m/rad]
  double energy_residual{};      ///< supplied - stored - dissipated - released energy since the last reset [J]
  double dissipated_energy{};    ///< energy that all friction dissipated since the last reset [J]
  double released_energy{};      ///< stored energy that faults released when they set in, since the last reset [J]
  bool brake_engaged{};          ///< whether the brake holds the motor within brake.play
  bool converged{ true };        ///< false: the ring did not converge, and the twin keeps the last converged state
  std::uint32_t iterations{};    ///< number of Newton iterations of the last step
  std::uint32_t substeps{};  ///< number of substeps of the last step, 1 ... 31; more than 1 for short natural periods
  double residual{};         ///< largest out-of-balance force component on a tooth [N]
  double phase_advance{};    ///< phase by which the joint's fastest natural mode advances in a substep [rad]
};

/// Forces and positions of the teeth, with one value for each tooth of the flexspline. `Twin::makeToothForces` sets the
/// sizes. The signs are those of ContactForces.msg.
struct ToothForces
{
  std::vector<double> wave_generator_force;  ///< force of the wave generator on the tooth, >= 0 [N]
  std::vector<double> rim_tension;           ///< tension of the rim to the next tooth [N]
  std::vector<double> bending_force;         ///< bending force of the segment to the next tooth [N]
  std::vector<double> mesh_force;            ///< force normal to the flank, > 0 leading, < 0 trailing flank [N]
  std::vector<double> tooth_x;               ///< x of the tooth point in the axes of the housing [m]
  std::vector<double> tooth_y;               ///< y of the tooth point in the axes of the housing [m]
};

/// State of the solver over several steps, with the values of Health.msg.
enum class SolverState : std::uint8_t
{
  OK = 0,        ///< every step converged without a cut
  DEGRADED = 1,  ///< some steps were cut or too long, or teeth jumped, see TwinCounters
  FAILED = 2     ///< a step found no equilibrium, and the twin kept the last converged state
};

/// Health indicators that JointOutputs does not contain, as in Health.msg.
struct HealthReport
{
  MotionIndicators motion;     ///< indicators over the last turns, from the true angles
  LobeLoads lobes;             ///< loads of the lobes at the current instant
  SolverState solver_state{};  ///< state of the solver over the steps that Twin::health names
  /// expected rms error of the forces on loaded flanks at the present speed and load: the ring has no inertia [N]
  double mesh_force_error{};
};

/// Numbers of steps and inputs since the last reset, for diagnostics.
struct TwinCounters
{
  std::uint64_t steps{};             ///< number of all steps
  std::uint64_t solver_failures{};   ///< steps that did not converge; the twin kept the last converged state
  std::uint64_t step_cuts{};         ///< steps in which the solver divided the path to the new angles
  std::uint64_t jumps{};             ///< steps in which a tooth passed over a tip into another space
  std::uint64_t coarse_steps{};      ///< steps that were too long for the fastest oscillation of the joint
  InputCounters input;               ///< numbers of inputs, without faults
  FaultCounters faults;              ///< numbers of injected faults
  std::uint64_t torque_clamped{};    ///< steps in which the command exceeded motor.torque_limit
  std::uint64_t load_clamped{};      ///< steps in which the load exceeded output.load_torque_limit
  std::uint64_t overloads{};         ///< steps in which the joint's torque exceeded output.torque_limit
  std::uint64_t speed_limited{};     ///< steps in which motor.speed_limit reduced the torque
  std::uint64_t command_timeouts{};  ///< number of commands that became older than input.command_timeout
};

/// The twin of one joint. Inputs are commanded torques. Outputs are encoder angles, tooth forces and health.
///
/// Inputs act at their stamps, and all instants are multiples of the solver's step. Equal inputs with equal stamps
/// therefore give equal results live, replayed and offline, for any sequence of calls of `step`. After construction no
/// member throws or allocates unless its comment says so. Const members do not change the simulation, and several
/// threads may call them at once between two steps.
class Twin
{
public:
  /// Solves the insertion of the wave generator, which takes milliseconds. For solver.scene = auto the constructor also
  /// reads the drive's response surface from the cache or builds it, which takes seconds (but see
  /// SurfaceSource::background). @throws ParameterError if a parameter is invalid, or if the joint, with the faults
  /// that are active at the start, has no equilibrium.
  explicit Twin(const Parameters& parameters, const SurfaceSource& surface_source = {});
  ~Twin();
  Twin(Twin&&) noexcept;
  Twin& operator=(Twin&&) noexcept;
  /// Copies the state at the current instant, with waiting inputs and learned references. With equal inputs, copy and
  /// original give bitwise equal results. They share finished response surfaces; the copy builds an unfinished surface
  /// again in a separate thread. Copying, assignment and the first steps of the copy allocate.
  Twin(const Twin& other);
  Twin& operator=(const Twin& other);

  const Parameters& parameters() const noexcept;  ///< parameters given to the constructor, without injected faults

  /// Restarts at rest, at the motor angle 0 and with the configured faults, at the first instant not before `stamp`.
  /// Discards inputs, injected faults and counts. @returns false and changes nothing for a stamp beyond +-MAX_STAMP.
  bool reset(Stamp stamp) noexcept;

  /// Queues an input, which acts from its stamp on. The twin refuses and counts values that are not finite. A late
  /// input is counted and acts at once, unless a newer input of its kind already acts. Torques are in [N.m]. A load
  /// torque > 0 resists positive motion. The temperature [degC] is that of the drive or, if thermal.model is two_nodes,
  /// that of its surroundings. The twin limits the temperature to its range.
  void commandMotorTorque(Stamp stamp, double torque) noexcept { push({ stamp, InputKind::MOTOR_TORQUE, torque }); }
  void commandLoadTorque(Stamp stamp, double torque) noexcept { push({ stamp, InputKind::LOAD_TORQUE, torque }); }
  void commandBrake(Stamp stamp, bool engaged) noexcept { push({ stamp, InputKind::BRAKE, engaged ? 1.0 : 0.0 }); }
  void setTemperature(Stamp stamp, double degrees) noexcept { push({ stamp, InputKind::TEMPERATURE, degrees }); }

  /// Queues a fault, which sets in `fault.onset` after the stamp. The severity 0 removes the fault of this kind and
  /// place. The twin refuses and counts an invalid fault, or a stamp beyond +-MAX_STAMP. Without a response surface for
  /// the active faults (SurfaceSource::background builds it), the twin solves all teeth at every step.
  void injectFault(Stamp stamp, const Fault& fault) noexcept;
  const FaultList& activeFaults() const noexcept;  ///< faults that are active at the current instant

  void push(const Input& input) noexcept;      ///< queues an input of any kind
  void push(const TwinInput& input) noexcept;  ///< queues an input or a fault

  /// Couples an arm to the joint, from the next step until the next call. `inertia`: finite, >= 0, replaces
  /// output.load_inertia [kg.m^2]. `torque`: finite, acts on the output in addition to the load torque, > 0 resists
  /// positive motion [N.m]. After a reset the joint is at rest under this torque.
  void coupleArm(double inertia, double torque) noexcept;
  double linkTorque() const noexcept;  ///< torque that gear and friction exert on load and arm [N.m]
  /// Work on load and arm plus kinetic energy of the output since the last reset [J].
  double deliveredEnergy() const noexcept;

  /// Advances by one solver step if the next instant is not after `until`. @returns whether the twin advanced.
  bool step(Stamp until) noexcept;

  Stamp stamp() const noexcept;       ///< current instant [ns]
  Stamp stepLength() const noexcept;  ///< length of a solver step [ns]

  JointOutputs outputs() const noexcept;          ///< true state at the current instant
  EncoderReadings encoders() const noexcept;      ///< readings of the encoders, with sensor errors
  double motorTorqueReading() const noexcept;     ///< torque of the motor that follows from its current reading [N.m]
  const TwinCounters& counters() const noexcept;  ///< numbers of steps and inputs since the last reset
  /// whether the state at the current instant comes from the response surface and not from the full ring
  bool onSurface() const noexcept;

  ToothForces makeToothForces() const;  ///< arrays of the right size for toothForces; allocates
  /// Computes the tooth forces at the current instant. On the response surface the forces come from a table of forces
  /// or, without such a table, from a separate full ring. @returns false if this ring has no equilibrium.
  bool toothForces(ToothForces& forces) noexcept;
  /// Computes the stresses of the flexspline like toothForces. `stress` must have one entry for each tooth.
  bool toothStress(ToothStress& stress) noexcept;
  /// Health at the current instant. HealthReport::solver_state covers the steps after `since` [ns], or all steps since
  /// the last reset if `since` is not before the current instant.
  HealthReport health(Stamp since = std::numeric_limits<Stamp>::min()) const noexcept;

  /// Switches the computation of indicators and assessment, initially off. `reset` discards learned references.
  void watchSignals(bool on) noexcept;
  bool watchesSignals() const noexcept;  ///< whether the twin computes indicators and assessment
  /// From the next window on, estimates the slip of the bearing and computes its lines with this slip, as for a
  /// recording. This is not for a control loop, because each window stores all its samples, and steps allocate.
  void seekBearingSlip();
  const SignalIndicators& signalIndicators() const noexcept;  ///< indicators of the last window
  /// Assessment of the last window. After an alarm the twin searches for the cause until 50 ms after the window.
  const Assessment& assessment() const noexcept;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace hjt
