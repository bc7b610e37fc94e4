// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/twin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "harmonic_joint_twin/base/errors.hpp"
#include "health/health_monitor.hpp"
#include "health/signal_monitor.hpp"
#include "model/faults/joint_faults.hpp"
#include "model/lobe_loads.hpp"
#include "solver/joint_stepper.hpp"
#include "surface/surface_worker.hpp"

namespace hjt
{
namespace
{
bool isSame(const FaultList& one, const FaultList& other) noexcept
{
  return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [](const ActiveFault& a, const ActiveFault& b) {
                      return a.fault.kind == b.fault.kind && a.fault.place == b.fault.place &&
                             a.fault.severity == b.fault.severity;
                    });
}
}  // namespace

struct Twin::Impl
{
  Impl(const Parameters& given, const SurfaceSource& surface_source)
    : parameters(given)
    , faults(given)
    , model(faults.model())
    , waiting(given)
    , stepper(given, model)
    , step_length(static_cast<Stamp>(std::llround(1e9 / given.solver.rate)))
    , sensors(given.sensors, 1.0 / given.solver.rate)
    , monitor(given.health, given.gear)
    , signals(given)
    , assessor(given)
    , steps_per_sample(std::max<Stamp>(std::llround(given.solver.rate / given.indicators.sample_rate), 1))
    , tooth_angles(Eigen::VectorXd::LinSpaced(given.gear.teeth_flexspline, 0.0,
                                              (given.gear.teeth_flexspline - 1) * model.ring.rest.pitchAngle()))
  {
    if (given.solver.scene == SceneKind::AUTO)
    {
      scheduleConfigured(0);
      faults.apply(active);
      prepareSurface(surface_source);
    }
    if (!reset(0))
    {
      throw ParameterError(
          "the faults that the twin starts with leave it no equilibrium: the insertion of the wave "
          "generator did not converge (faults.*)");
    }
  }

  /// The surface of the drive with the faults it starts with.
  void prepareSurface(const SurfaceSource& source)
  {
    surface_faults = active;
    if (source.background)
    {
      surface_worker = std::make_unique<SurfaceWorker>(parameters, active, source);
    }
    else
    {
      surface = surfaceWithFaults(parameters, active, source);
    }
  }

  /// The surface while it is that of the present faults; else the full ring, until one is there that was built beside.
  void useSurface() noexcept
  {
    const ResponseSurface* ready = surface_worker ? surface_worker->surface() : surface.get();
    const bool fits = ready != nullptr && isSame(active, surface_faults);
    stepper.useSurface(fits ? ready : nullptr);
    surface_awaited = surface_worker && !fits;
  }

  bool reset(Stamp stamp) noexcept
  {
    stepper.useSurface(nullptr);
    scheduleConfigured(stamp);
    faults.apply(active);
    useSurface();
    const bool settled = stepper.reset();
    queue.clear();
    counters = {};
    now = (stamp > 0 ? (stamp + step_length - 1) / step_length : stamp / step_length) * step_length;
    simulated_until = stamp;
    in_force_since.fill(std::numeric_limits<Stamp>::min());
    command = 0.0;
    commanded = false;
    load_torque = 0.0;
    load_clamped = false;
    temperature = parameters.input.temperature;
    brake_engaged = parameters.brake.engaged_at_start;
    sensors.reset();
    monitor.reset();
    signals.reset();
    assessor.reset();
    outputs = {};
    steps_at_report = {};
    fillOutputs(0.0, true);
    observe();
    return settled;
  }

  static Stamp delayOf(const Fault& fault) noexcept { return static_cast<Stamp>(std::llround(1e9 * fault.onset)); }

  void scheduleConfigured(Stamp stamp) noexcept;
  bool takeFaults() noexcept;
  void step() noexcept;
  void takeInputs() noexcept;
  void takeSurface() noexcept;
  double commandInForce() noexcept;
  bool overshoots(const Motor::Drive& drive) const noexcept;
  void fillOutputs(double motor_torque, bool converged) noexcept;
  void observe() noexcept;
  void takeReadings() noexcept;
  SolverState solverState() noexcept;
  LobeLoads lobes() const noexcept;

  Parameters parameters;
  JointFaults faults;
  const JointModel& model;
  FaultList active;
  FaultSchedule waiting;
  FaultList surface_faults;  // that the surface was asked for with
  std::shared_ptr<const ResponseSurface> surface;
  std::unique_ptr<SurfaceWorker> surface_worker;
  bool surface_awaited{};
  JointStepper stepper;
  Stamp step_length;
  Stamp now{};
  Stamp simulated_until{};  // an input with an earlier stamp is late: now, or the start if that is not on the grid
  InputQueue queue;
  std::array<Stamp, INPUT_KINDS> in_force_since{};  // stamp of the input in force, by kind
  TwinCounters counters;
  double command{};      // last motor torque command [N.m]
  bool commanded{};      // a command is in force, not timed out
  double load_torque{};  // last load torque, clamped [N.m]
  bool load_clamped{};
  double temperature{};  // [degC]
  bool brake_engaged{};
  JointOutputs outputs;
  JointSensors sensors;
  HealthMonitor monitor;
  SignalMonitor signals;
  Assessor assessor;
  Stamp steps_per_sample;
  bool watching{};               // indicators are made of the readings
  Eigen::VectorXd tooth_angles;  // at rest [rad]
  TwinCounters steps_at_report;  // counters when health was last asked for
};

/// The configured faults: those from the start on are there, the others wait.
void Twin::Impl::scheduleConfigured(Stamp stamp) noexcept
{
  active.clear();
  waiting.clear();
  for (const Fault& fault : parameters.faults)
  {
    if (fault.isThereFromTheStart())
    {
      active.set(fault, stamp);
    }
    else
    {
      waiting.push(fault, stamp + delayOf(fault));
    }
  }
}

/// Faults whose time has come. @returns false if the ring found no equilibrium with them.
bool Twin::Impl::takeFaults() noexcept
{
  const std::uint64_t version = active.version();
  Fault fault;
  Stamp stamp{};
  while (waiting.pop(now, fault, stamp))
  {
    counters.faults.no_room += active.set(fault, stamp) ? 0 : 1;
  }
  if (active.version() == version)
  {
    return true;
  }
  stepper.useSurface(nullptr);
  faults.apply(active);
  const bool good = stepper.followModel();
  useSurface();
  return good;
}

void Twin::Impl::takeInputs() noexcept
{
  Input input;
  while (queue.pop(now, input))
  {
    Stamp& since = in_force_since[static_cast<std::size_t>(input.kind)];
    if (input.stamp < since)
    {
      continue;  // late, and a newer one is in force
    }
    since = input.stamp;
    switch (input.kind)
    {
      case InputKind::MOTOR_TORQUE:
        command = input.value;
        commanded = true;
        break;
      case InputKind::LOAD_TORQUE:
        load_torque =
            std::clamp(input.value, -parameters.output.load_torque_limit, parameters.output.load_torque_limit);
        load_clamped = load_torque != input.value;
        break;
      case InputKind::BRAKE:
        brake_engaged = input.value != 0.0;
        break;
      case InputKind::TEMPERATURE:
        temperature = std::clamp(input.value, LOWEST_TEMPERATURE, HIGHEST_TEMPERATURE);
        break;
      case InputKind::FAULT:
        break;
    }
  }
  counters.input = queue.counters();
}

/// The surface of the present faults that is built beside: asked for, and used when it is there.
void Twin::Impl::takeSurface() noexcept
{
  if (!surface_awaited)
  {
    return;
  }
  if (!isSame(active, surface_faults))
  {
    if (surface_worker->request(active))
    {
      surface_faults = active;
    }
  }
  else if (surface_worker->surface() != nullptr)
  {
    useSurface();
  }
}

/// The latest command, or zero when it has timed out.
double Twin::Impl::commandInForce() noexcept
{
  const double age =
      1e-9 * static_cast<double>(now - in_force_since[static_cast<std::size_t>(InputKind::MOTOR_TORQUE)]);
  if (commanded && age > parameters.input.command_timeout)
  {
    commanded = false;
    ++counters.command_timeouts;
  }
  return commanded ? command : 0.0;
}

/// Whether the drive, which sees the motor's speed once a step, holds the speed limit too stiffly for that.
bool Twin::Impl::overshoots(const Motor::Drive& drive) const noexcept
{
  return drive.slope > model.motor.inertia() * parameters.solver.rate;
}

void Twin::Impl::step() noexcept
{
  now += step_length;
  simulated_until = now;
  const bool followed = takeFaults();
  takeInputs();
  takeSurface();
  const Motor::Drive drive = model.motor.drive(commandInForce(), stepper.speeds()[0]);
  const bool converged = stepper.step({ drive.torque, load_torque, brake_engaged, temperature }) && followed;
  ++counters.steps;
  counters.torque_clamped += drive.clamped ? 1 : 0;
  counters.speed_limited += drive.held ? 1 : 0;
  counters.load_clamped += load_clamped ? 1 : 0;
  counters.solver_failures += converged ? 0 : 1;
  counters.step_cuts += stepper.status().cuts > 0 ? 1 : 0;
  counters.jumps += stepper.status().jumps > 0 ? 1 : 0;
  fillOutputs(drive.torque, converged);
  counters.coarse_steps += outputs.swing_phase > JointStepper::MAX_SWING_PHASE || overshoots(drive) ? 1 : 0;
  observe();
}

void Twin::Impl::fillOutputs(double motor_torque, bool converged) noexcept
{
  const RingResponse& ring = stepper.dynamics().response();
  const Eigen::Vector2d& friction = stepper.frictionTorque();
  outputs.stamp = now;
  outputs.motor_angle = stepper.motorAngle();
  outputs.motor_velocity = stepper.speeds()[0];
  outputs.output_angle = stepper.outputAngle();
  outputs.output_velocity = stepper.speeds()[1];
  outputs.motor_torque = motor_torque;
  outputs.load_torque = load_torque;
  outputs.temperature = temperature;
  outputs.wave_generator_torque = -ring.wave_generator_torque;
  outputs.joint_torque = ring.output_torque;
  outputs.friction_torque = std::abs(friction[0] + ring.follow * friction[1]);
  outputs.torsional_stiffness = ring.output_stiffness;
  outputs.energy_residual = stepper.energyResidual();
  outputs.released_energy = stepper.releasedEnergy();
  outputs.brake_engaged = brake_engaged;
  outputs.converged = converged;
  outputs.iterations = static_cast<std::uint32_t>(stepper.status().iterations);
  outputs.residual = stepper.status().residual;
  outputs.swing_phase = stepper.swingPhase();
}

/// What watches the joint step by step: sensors and health.
void Twin::Impl::observe() noexcept
{
  sensors.update(now / step_length, outputs.motor_angle, outputs.output_angle, outputs.motor_torque);
  monitor.update({ now, outputs.motor_angle, outputs.motor_velocity, outputs.output_angle, outputs.output_velocity,
                   outputs.motor_torque, outputs.joint_torque });
  if (watching && now / step_length % steps_per_sample == 0)
  {
    takeReadings();
  }
}

/// What a drive would know: readings, the load it was told, its temperature.
void Twin::Impl::takeReadings() noexcept
{
  const EncoderReadings readings = sensors.encoders();
  SignalSample sample;
  sample.stamp = now;
  sample.motor_angle = readings.motor_angle;
  sample.output_angle = readings.output_angle;
  sample.motor_velocity = readings.motor_velocity;
  sample.motor_torque = sensors.motorTorque();
  sample.load_torque = load_torque;
  sample.temperature = temperature;
  if (signals.update(sample))
  {
    assessor.take(signals.indicators());
  }
}

SolverState Twin::Impl::solverState() noexcept
{
  const bool failed = counters.solver_failures > steps_at_report.solver_failures;
  const bool doubtful = counters.step_cuts > steps_at_report.step_cuts ||
                        counters.coarse_steps > steps_at_report.coarse_steps || counters.jumps > steps_at_report.jumps;
  steps_at_report = counters;
  return failed ? SolverState::FAILED : doubtful ? SolverState::DEGRADED : SolverState::OK;
}

/// How the load is shared at the current instant.
LobeLoads Twin::Impl::lobes() const noexcept
{
  const JointDynamics& dynamics = stepper.dynamics();
  if (!dynamics.onSurface())
  {
    const RingForces& forces = dynamics.ring().forces();
    return lobeLoads({ forces.of<ToothMesh>().flank_force, forces.of<WaveGeneratorContact>().force, tooth_angles,
                       outputs.motor_angle });
  }
  const auto value = [&](int which) { return ResponseSurface::value(dynamics.surfacePlace(), which); };
  LobeLoads loads;
  loads.teeth_loaded = static_cast<int>(std::lround(value(SurfaceTable::TEETH_LOADED)));
  loads.mesh_force = ResponseSurface::lobeForces(dynamics.surfacePlace());
  const double sum = loads.mesh_force[0] + loads.mesh_force[1];
  loads.asymmetry = sum > 0.0 ? (loads.mesh_force[0] - loads.mesh_force[1]) / sum : 0.0;
  loads.wave_generator_force = value(SurfaceTable::CONTACT_FORCE);
  return loads;
}

Twin::Twin(const Parameters& parameters, const SurfaceSource& surface_source)
{
  if (parameters.contact.law == ContactLaw::POLAR)
  {
    throw ParameterError(
        "contact.law = polar is not the gradient of an energy: only the insertion analysis may use it; "
        "allowed for the running twin: normal");
  }
  impl_ = std::make_unique<Impl>(parameters, surface_source);
}

Twin::~Twin() = default;
Twin::Twin(Twin&&) noexcept = default;
Twin& Twin::operator=(Twin&&) noexcept = default;

const Parameters& Twin::parameters() const noexcept
{
  return impl_->parameters;
}

void Twin::reset(Stamp stamp) noexcept
{
  impl_->reset(stamp);
}

void Twin::commandMotorTorque(Stamp stamp, double torque) noexcept
{
  impl_->queue.push({ stamp, InputKind::MOTOR_TORQUE, torque }, impl_->simulated_until);
}

void Twin::commandLoadTorque(Stamp stamp, double torque) noexcept
{
  impl_->queue.push({ stamp, InputKind::LOAD_TORQUE, torque }, impl_->simulated_until);
}

void Twin::commandBrake(Stamp stamp, bool engaged) noexcept
{
  impl_->queue.push({ stamp, InputKind::BRAKE, engaged ? 1.0 : 0.0 }, impl_->simulated_until);
}

void Twin::setTemperature(Stamp stamp, double temperature) noexcept
{
  impl_->queue.push({ stamp, InputKind::TEMPERATURE, temperature }, impl_->simulated_until);
}

void Twin::injectFault(Stamp stamp, const Fault& fault) noexcept
{
  FaultCounters& counted = impl_->counters.faults;
  if (!isValid(fault, impl_->parameters))
  {
    ++counted.refused;
    return;
  }
  const Stamp sets_in = stamp + Impl::delayOf(fault);
  if (!impl_->waiting.push(fault, sets_in))
  {
    ++counted.no_room;
    return;
  }
  ++counted.accepted;
  counted.late += sets_in < impl_->simulated_until ? 1 : 0;
}

const FaultList& Twin::activeFaults() const noexcept
{
  return impl_->active;
}

void Twin::give(const Input& input) noexcept
{
  if (input.kind == InputKind::FAULT)
  {
    injectFault(input.stamp, input.fault);
    return;
  }
  impl_->queue.push(input, impl_->simulated_until);
}

bool Twin::step(Stamp until) noexcept
{
  if (impl_->now + impl_->step_length > until)
  {
    return false;
  }
  impl_->step();
  return true;
}

Stamp Twin::stamp() const noexcept
{
  return impl_->now;
}

Stamp Twin::stepLength() const noexcept
{
  return impl_->step_length;
}

const JointOutputs& Twin::outputs() const noexcept
{
  return impl_->outputs;
}

const TwinCounters& Twin::counters() const noexcept
{
  return impl_->counters;
}

bool Twin::onSurface() const noexcept
{
  return impl_->stepper.dynamics().onSurface();
}

EncoderReadings Twin::encoders() const noexcept
{
  return impl_->sensors.encoders();
}

double Twin::motorTorqueReading() const noexcept
{
  return impl_->sensors.motorTorque();
}

HealthReport Twin::health() noexcept
{
  const JointOutputs& joint = impl_->outputs;
  const MotionIndicators motion = impl_->monitor.indicators();
  const LobeLoads lobes = impl_->lobes();
  HealthReport report;
  report.transmission_ratio_valid = motion.transmission_ratio.valid;
  report.transmission_ratio = motion.transmission_ratio.value;
  report.torsion = motion.torsion;
  report.torsional_stiffness_valid = motion.torsional_stiffness.valid;
  report.torsional_stiffness = motion.torsional_stiffness.value;
  report.torsional_stiffness_model = joint.torsional_stiffness;
  report.teeth_loaded = static_cast<std::uint32_t>(lobes.teeth_loaded);
  report.lobe_mesh_force = lobes.mesh_force;
  report.lobe_asymmetry = lobes.asymmetry;
  report.wave_generator_load = lobes.wave_generator_force;
  report.friction_torque = joint.friction_torque;
  report.efficiency_valid = motion.efficiency.valid;
  report.efficiency = motion.efficiency.value;
  report.kinematic_error_valid = motion.kinematic_error.valid;
  report.kinematic_error = motion.kinematic_error.value;
  report.motor_torque = joint.motor_torque;
  report.joint_torque = joint.joint_torque;
  report.energy_residual = joint.energy_residual;
  report.solver_iterations = joint.iterations;
  report.solver_residual = joint.residual;
  report.solver_failures = impl_->counters.solver_failures;
  report.solver_state = impl_->solverState();
  return report;
}

void Twin::watchSignals(bool on) noexcept
{
  impl_->watching = on;
}

bool Twin::watchesSignals() const noexcept
{
  return impl_->watching;
}

const SignalIndicators& Twin::signalIndicators() const noexcept
{
  return impl_->signals.indicators();
}

const Assessment& Twin::assessment() const noexcept
{
  return impl_->assessor.assessment();
}

ToothForces Twin::makeToothForces() const
{
  const std::vector<double> zeros(static_cast<std::size_t>(impl_->parameters.gear.teeth_flexspline), 0.0);
  return { zeros, zeros, zeros, zeros, zeros, zeros };
}

void Twin::toothForces(ToothForces& out) const noexcept
{
  impl_->counters.solver_failures += impl_->stepper.bringRing().ok() ? 0 : 1;
  const RingEquilibrium& ring = impl_->stepper.dynamics().ring();
  const RingModel& model = ring.model();
  const RingShape& shape = ring.shape();
  for (int i = 0; i < shape.teeth(); ++i)
  {
    out.wave_generator_force[i] = ring.forces().of<WaveGeneratorContact>().force[i];
    out.rim_tension[i] = model.of<RimTension>().tension(shape, i);
    out.bending_force[i] = model.of<RimBending>().bendingForce(shape, ring.forces().of<RimBending>(), i);
    out.mesh_force[i] = ring.forces().of<ToothMesh>().flank_force[i];
    out.tooth_x[i] = shape.points[2 * i];
    out.tooth_y[i] = shape.points[2 * i + 1];
  }
}
}  // namespace hjt
