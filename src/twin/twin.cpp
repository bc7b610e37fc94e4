// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/twin.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "harmonic_joint_twin/base/errors.hpp"
#include "model/lobe_loads.hpp"
#include "statics/flexspline_stress.hpp"
#include "statics/gear_rules.hpp"
#include "statics/inertia_error.hpp"
#include "twin/tooth_forces.hpp"
#include "twin/twin_impl.hpp"

namespace hjt
{
Twin::Twin(const Parameters& parameters, const SurfaceSource& surface_source)
{
  if (parameters.contact.law == ContactLaw::POLAR)
  {
    throw ParameterError(
        "contact.law = polar has no potential energy, so that only the analysis of the insertion can use it. "
        "A running twin needs contact.law = normal");
  }
  if (const std::string jam = jamOf(parameters); !jam.empty())
  {
    throw ParameterError(jam);
  }
  impl_ = std::make_unique<Impl>(parameters, surface_source);
}

Twin::~Twin() = default;
Twin::Twin(Twin&&) noexcept = default;
Twin& Twin::operator=(Twin&&) noexcept = default;

Twin::Twin(const Twin& other) : impl_(Impl::copyOf(*other.impl_)) {}

Twin& Twin::operator=(const Twin& other)
{
  return *this = Twin(other);
}

const Parameters& Twin::parameters() const noexcept
{
  return impl_->parameters;
}

bool Twin::reset(Stamp stamp) noexcept
{
  if (!isStamp(stamp))
  {
    return false;
  }
  impl_->reset(stamp);
  return true;
}

void Twin::injectFault(Stamp stamp, const Fault& fault) noexcept
{
  FaultCounters& counted = impl_->counters.faults;
  if (!isStamp(stamp) || !isValid(fault, impl_->parameters))
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

void Twin::push(const Input& input) noexcept
{
  impl_->queue.push(input, impl_->simulated_until);
  impl_->counters.input = impl_->queue.counters();
}

void Twin::push(const TwinInput& input) noexcept
{
  if (const auto* fault = std::get_if<StampedFault>(&input))
  {
    injectFault(fault->stamp, fault->fault);
  }
  else
  {
    push(*std::get_if<Input>(&input));
  }
}

void Twin::coupleArm(double inertia, double torque) noexcept
{
  impl_->stepper.setOutputInertia(impl_->parameters.output.circular_spline_inertia + inertia);
  impl_->arm_torque = torque;
}

double Twin::linkTorque() const noexcept
{
  return impl_->stepper.linkTorque();
}

double Twin::deliveredEnergy() const noexcept
{
  return impl_->stepper.deliveredEnergy();
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

JointOutputs Twin::outputs() const noexcept
{
  return impl_->outputs();
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

HealthReport Twin::health(Stamp since) const noexcept
{
  const JointOutputs now = outputs();
  return { impl_->monitor.indicators(), impl_->lobes(), impl_->solverState(since),
           expectedMeshForceError(impl_->parameters.ring, impl_->parameters.gear, now.motor_velocity,
                                  now.joint_torque) };
}

void Twin::watchSignals(bool on) noexcept
{
  impl_->watching = on;
}

void Twin::seekBearingSlip()
{
  impl_->signals.seekBearingSlip(impl_->parameters);
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

bool Twin::toothForces(ToothForces& out) noexcept
{
  if (fillToothForces(impl_->stepper.dynamics(), out))
  {
    return true;
  }
  const RingEquilibrium* ring = impl_->observed_ring.at(impl_->stepper.dynamics());
  if (ring == nullptr)
  {
    return false;
  }
  fillToothForces(*ring, 0, out);
  return true;
}

bool Twin::toothStress(ToothStress& stress) noexcept
{
  const RingEquilibrium* ring = impl_->observed_ring.at(impl_->stepper.dynamics());
  if (ring == nullptr)
  {
    return false;
  }
  FlexsplineStress(impl_->parameters).at(*ring, 0, stress);
  return true;
}

Twin::Impl::Impl(const Parameters& given, const SurfaceSource& surface_source)
  : parameters(given)
  , faults(given)
  , waiting(given)
  , stepper(given, model())
  , observed_ring(model().ring, given.solver)
  , step_length(static_cast<Stamp>(std::llround(1e9 / given.solver.rate)))
  , sensors(given.sensors, 1.0 / given.solver.rate)
  , monitor(given.health, given.gear)
  , signals(given)
  , assessor(given)
  , steps_per_sample(std::llround(given.solver.rate / given.indicators.sample_rate))
  , searched_per_step(static_cast<std::size_t>(
        std::ceil(static_cast<double>(assessor.searchLength()) / (CAUSE_SEARCH_TIME * given.solver.rate))))
  , steps_per_heat(std::max<Stamp>(std::llround(given.solver.rate * DriveHeat::PERIOD), 1))
  , tooth_angles(Eigen::VectorXd::LinSpaced(given.gear.teeth_flexspline, 0.0,
                                            (given.gear.teeth_flexspline - 1) * model().ring.rest.pitchAngle()))
{
  if (given.thermal.model == ThermalModel::TWO_NODES)
  {
    heat.emplace(given.thermal);
  }
  if (given.solver.scene == SceneKind::AUTO)
  {
    scheduleConfigured(0);
    faults.apply(active);
    prepareSurface(surface_source);
  }
  if (!reset(0))
  {
    throw ParameterError("the twin has no equilibrium with the faults that are active at its start (faults.*): " +
                         explanationOf(stepper.status()));
  }
}

std::unique_ptr<Twin::Impl> Twin::Impl::copyOf(const Impl& other)
{
  std::unique_ptr<Impl> copy(new Impl(other));
  copy->stepper.setModel(copy->model());
  copy->observed_ring.setModel(copy->model().ring);
  return copy;
}

bool Twin::Impl::reset(Stamp stamp) noexcept
{
  static_cast<void>(stepper.useSurface(nullptr));  // the status does not matter, because the ring is inserted anew
  scheduleConfigured(stamp);
  faults.apply(active);
  useSurface();
  const bool settled = stepper.reset(arm_torque);
  observed_ring.restart();
  queue.clear();
  counters = {};
  instant = stamp > 0 ? (stamp + step_length - 1) / step_length : stamp / step_length;
  now = instant * step_length;
  simulated_until = stamp;
  in_force_since.fill(std::numeric_limits<Stamp>::min());
  motor_torque = {};
  command_clamped = false;
  commanded = false;
  load_torque = {};
  load_clamped = false;
  temperature = parameters.input.temperature;
  resetHeat();
  brake_engaged = parameters.brake.engaged_at_start;
  brake_commanded = brake_engaged;
  sensors.reset();
  monitor.reset();
  signals.reset();
  assessor.reset();
  last_doubtful = std::numeric_limits<Stamp>::min();
  last_failed = settled ? last_doubtful : now;
  converged = settled;
  counters.solver_failures = settled ? 0 : 1;
  observe();
  return settled;
}

/// Activates the configured faults without an onset and schedules the other configured faults.
void Twin::Impl::scheduleConfigured(Stamp stamp) noexcept
{
  active.clear();
  waiting.clear();
  for (const Fault& fault : parameters.faults)
  {
    if (fault.isActiveAtStart())
    {
      active.set(fault, stamp);
    }
    else
    {
      waiting.push(fault, stamp + delayOf(fault));
    }
  }
}

/// Activates or removes the faults that are due. @returns false if the ring has no equilibrium with the new faults.
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
  bool good = stepper.useSurface(nullptr);
  faults.apply(active);
  good = stepper.updateModel() && good;
  observed_ring.restart();
  return useSurface() && good;
}

/// Applies the inputs with stamps in the step from `begin` to `now`, each from its stamp on.
void Twin::Impl::takeInputs(Stamp begin) noexcept
{
  motor_torque.begin(begin);
  load_torque.begin(begin);
  timeOutCommand(begin);
  if (!queue.isDue(now - 1))
  {
    return;
  }
  Input input;
  while (queue.pop(now - 1, input))
  {
    Stamp& since = in_force_since[static_cast<std::size_t>(input.kind)];
    if (input.stamp >= since)  // false for a late input if a newer input already acts
    {
      since = input.stamp;
      takeInput(input, std::max(input.stamp, begin));
    }
  }
  timeOutCommand(begin);  // a command that arrived late can already be too old
}

void Twin::Impl::takeInput(const Input& input, Stamp at) noexcept
{
  switch (input.kind)
  {
    case InputKind::MOTOR_TORQUE:
      motor_torque.set(model().motor.clamped(input.value), at);
      command_clamped = motor_torque.value() != input.value;
      commanded = true;
      break;
    case InputKind::LOAD_TORQUE:
      load_torque.set(
          std::clamp(input.value, -parameters.output.load_torque_limit, parameters.output.load_torque_limit), at);
      load_clamped = load_torque.value() != input.value;
      break;
    case InputKind::BRAKE:
      if (const bool wanted = input.value != 0.0; wanted != brake_commanded)
      {
        brake_commanded = wanted;
        brake_moves = input.stamp + toStampLength(parameters.brake.delay);
      }
      break;
    case InputKind::TEMPERATURE:
      temperature = std::clamp(input.value, MIN_TEMPERATURE, MAX_TEMPERATURE);
      break;
  }
}

/// Sets the commanded torque to zero if the command is older than input.command_timeout at the beginning of the step.
void Twin::Impl::timeOutCommand(Stamp begin) noexcept
{
  const Stamp since = in_force_since[static_cast<std::size_t>(InputKind::MOTOR_TORQUE)];
  // The difference begin - since would overflow for a command with the earliest possible stamp.
  if (commanded && since < begin - toStampLength(parameters.input.command_timeout))
  {
    commanded = false;
    command_clamped = false;
    ++counters.command_timeouts;
    motor_torque.set(0.0, begin);
  }
}

void Twin::Impl::step() noexcept
{
  const Stamp begin = now;
  ++instant;
  now += step_length;
  simulated_until = now;
  const bool followed = !waiting.isDue(now) || takeFaults();
  takeInputs(begin);
  moveBrake(begin);
  const bool changed = takeSurface();
  const JointInputs inputs{ motor_torque.mean(now), load_torque.mean(now), brake_engaged, greaseTemperature(),
                            arm_torque };
  converged = stepper.step(inputs) && followed && changed;
  takeHeat(stepper.driveTorque());
  ++counters.steps;
  counters.torque_clamped += command_clamped ? 1 : 0;
  counters.speed_limited += stepper.isSpeedLimited() ? 1 : 0;
  counters.load_clamped += load_clamped ? 1 : 0;
  const bool cut = stepper.status().cuts > 0;
  const bool jumped = stepper.status().jumps > 0;
  const bool coarse = stepper.isCoarse();
  counters.overloads += std::abs(stepper.dynamics().response().output_torque) > parameters.output.torque_limit ? 1 : 0;
  counters.solver_failures += converged ? 0 : 1;
  counters.step_cuts += cut ? 1 : 0;
  counters.jumps += jumped ? 1 : 0;
  counters.coarse_steps += coarse ? 1 : 0;
  last_failed = converged ? last_failed : now;
  last_doubtful = cut || jumped || coarse ? now : last_doubtful;
  observe();
}

/// Executes the last command of the brake at the first instant after brake.delay.
void Twin::Impl::moveBrake(Stamp begin) noexcept
{
  if (brake_commanded != brake_engaged && begin >= brake_moves)
  {
    brake_engaged = brake_commanded;
  }
}

double Twin::Impl::greaseTemperature() const noexcept
{
  return heat ? std::clamp(heat->grease(), MIN_TEMPERATURE, MAX_TEMPERATURE) : temperature;
}

double Twin::Impl::housingTemperature() const noexcept
{
  return heat ? heat->housing() : temperature;
}

void Twin::Impl::resetHeat() noexcept
{
  heat_stamp = now;
  heat_booked = 0.0;
  copper_heat = 0.0;
  if (heat)
  {
    heat->reset(temperature);
  }
}

/// Adds the losses of a step. At the end of each DriveHeat::PERIOD (counted from time 0) the losses warm the drive.
void Twin::Impl::takeHeat(double motor_torque) noexcept
{
  if (!heat)
  {
    return;
  }
  copper_heat += parameters.motor.copper_loss * motor_torque * motor_torque / parameters.solver.rate;
  if (instant % steps_per_heat == 0)
  {
    const double dissipated = stepper.dissipatedEnergy();
    heat->advance(toSeconds(now - heat_stamp), { dissipated - heat_booked, copper_heat }, temperature);
    heat_stamp = now;
    heat_booked = dissipated;
    copper_heat = 0.0;
  }
}

JointOutputs Twin::Impl::outputs() const noexcept
{
  const RingResponse& ring = stepper.dynamics().response();
  const Eigen::Vector2d& friction = stepper.frictionTorque();
  JointOutputs outputs;
  outputs.stamp = now;
  outputs.motor_angle = stepper.motorAngle();
  outputs.motor_velocity = stepper.speeds()[0];
  outputs.output_angle = stepper.outputAngle();
  outputs.output_velocity = stepper.speeds()[1];
  outputs.motor_torque = stepper.dynamics().shaftTorque();
  outputs.load_torque = load_torque.value() + arm_torque;
  outputs.temperature = greaseTemperature();
  outputs.housing_temperature = housingTemperature();
  outputs.wave_generator_torque = -ring.wave_generator_torque;
  outputs.joint_torque = ring.output_torque;
  outputs.friction_torque = std::abs(friction[0] + ring.velocity_ratio * friction[1]);
  outputs.torsional_stiffness = ring.output_stiffness;
  outputs.energy_residual = stepper.energyResidual();
  outputs.dissipated_energy = stepper.dissipatedEnergy();
  outputs.released_energy = stepper.releasedEnergy();
  outputs.brake_engaged = brake_engaged;
  outputs.converged = converged;
  outputs.iterations = static_cast<std::uint32_t>(stepper.status().iterations);
  outputs.substeps = static_cast<std::uint32_t>(stepper.substeps());
  outputs.residual = stepper.status().residual;
  outputs.phase_advance = stepper.phaseAdvance();
  return outputs;
}

void Twin::Impl::observe() noexcept
{
  const JointDynamics& dynamics = stepper.dynamics();
  sensors.update(instant, stepper.motorAngle(), stepper.outputAngle(), stepper.driveTorque());
  monitor.update({ now, stepper.motorAngle(), stepper.speeds()[0], stepper.outputAngle(), stepper.speeds()[1],
                   dynamics.shaftTorque(), dynamics.response().output_torque });
  if (watching && instant % steps_per_sample == 0)
  {
    takeReadings();
  }
  assessor.advance(searched_per_step);
}

/// Passes the signals that a real drive has to the health monitor: readings, received load, temperature of the housing.
void Twin::Impl::takeReadings() noexcept
{
  const EncoderReadings readings = sensors.encoders();
  SignalSample sample;
  sample.stamp = now;
  sample.motor_angle = readings.motor_angle;
  sample.output_angle = readings.output_angle;
  sample.motor_velocity = readings.motor_velocity;
  sample.motor_torque = sensors.motorTorque();
  sample.load_torque = load_torque.value() + arm_torque;
  sample.temperature = housingTemperature();
  if (signals.update(sample))
  {
    assessor.begin(signals.indicators());
  }
}

SolverState Twin::Impl::solverState(Stamp since) const noexcept
{
  const Stamp after = since < now ? since : std::numeric_limits<Stamp>::min();
  return last_failed > after ? SolverState::FAILED : last_doubtful > after ? SolverState::DEGRADED : SolverState::OK;
}

LobeLoads Twin::Impl::lobes() const noexcept
{
  const JointDynamics& dynamics = stepper.dynamics();
  if (!dynamics.onSurface())
  {
    const RingForces& forces = dynamics.ring().forces();
    return lobeLoads({ forces.of<ToothMesh>().flank_force, forces.of<WaveGeneratorContact>().force, tooth_angles,
                       stepper.motorAngle() });
  }
  const auto value = [&](int which) { return ResponseSurface::value(dynamics.surfacePlace(), which); };
  LobeLoads loads;
  loads.teeth_loaded = static_cast<int>(std::lround(value(SurfaceNode::TEETH_LOADED)));
  loads.mesh_force = ResponseSurface::lobeForces(dynamics.surfacePlace());
  const double sum = loads.mesh_force[0] + loads.mesh_force[1];
  loads.asymmetry = sum > 0.0 ? (loads.mesh_force[0] - loads.mesh_force[1]) / sum : 0.0;
  loads.wave_generator_force = value(SurfaceNode::CONTACT_FORCE);
  return loads;
}
}  // namespace hjt
