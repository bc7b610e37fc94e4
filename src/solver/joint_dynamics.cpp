// SPDX-License-Identifier: BSD-3-Clause
#include "solver/joint_dynamics.hpp"

#include "elements/friction_laws.hpp"

namespace hjt
{
JointDynamics::JointDynamics(const JointModel& model, const SolverParameters& parameters)
  : model_(&model)
  , inertia_(model.inertia())
  , ring_(model.ring, parameters)
  , dry_(model.inertia(), parameters.stiction_velocity)
  , friction_(model.ring.rest.teeth())
  , sticking_(model.ring.rest.teeth())
  , remembers_(model.cup_friction.hasState() || model.motor.preslidingAngle() > 0.0 || model.brake.hasPlay())
  , temperature_(inputs.temperature)
  , viscosity_(model.bearing.viscosity(temperature_))
{
}

SolveStatus JointDynamics::solveAtRest() noexcept
{
  constexpr int MAX_ITERATIONS = 50;
  SolveStatus result = ring_.insert({ 0.0, 0.0, model_->ring.gear.wave_amplitude });
  // Each iteration assumes a constant torque of gravity. The joint is stiff, so the output angle, and with it the
  // torque of gravity, changes little between iterations.
  double torque = 0.0;
  for (int i = 0; result.ok(); ++i)
  {
    const double wanted = inputs.load() - model_->load.gravityTorque(ring_.position().output_angle);
    if (i > 0 && std::abs(wanted - torque) <= balanceTolerance(ring_))
    {
      break;
    }
    if (i == MAX_ITERATIONS)
    {
      result.code = SolveCode::UNBALANCED;
      result.stage = SolveStage::BALANCE;
      result.unbalanced_torque = wanted - torque;
      break;
    }
    torque = wanted;
    result = balanceOutput(ring_, 0.0, torque);
  }
  status = result;
  viscosity_ = model_->bearing.viscosity(temperature_);
  on_surface_ = false;
  takeRing();
  accepted_ = {};
  accepted_.motor_angle = motor_angle_;
  accepted_.cup = model_->cup_friction.relaxed(now_.cup.rotation);
  now_ = accepted_;
  surface_agrees_ = surface_ != nullptr && result.ok() && surfaceAgrees();
  return result;
}

bool JointDynamics::placeOnSurface(double motor_angle, double output_angle) noexcept
{
  if (!(on_surface_ || surface_agrees_) || !surface_->locate(motor_angle, output_angle, place_))
  {
    return false;
  }
  on_surface_ = true;
  surface_agrees_ = false;
  motor_angle_ = motor_angle;
  output_angle_ = output_angle;
  response_ = surface_->response(place_, housing_stiffness_);
  takeSurface();
  return true;
}

SolveStatus JointDynamics::place(double motor_angle, double output_angle) noexcept
{
  if (placeOnSurface(motor_angle, output_angle))
  {
    return {};
  }
  if (on_surface_ && !bringRing())  // placeRing moves the ring from the last angles to the new ones
  {
    return status;
  }
  on_surface_ = false;
  const SolveStatus result = placeRing(motor_angle, output_angle);
  takeRing();
  surface_agrees_ = surface_ != nullptr && result.ok() && surfaceAgrees();
  return result;
}

bool JointDynamics::useSurface(const ResponseSurface* surface) noexcept
{
  bool good = true;
  if (on_surface_ && surface != surface_)
  {
    on_surface_ = false;
    good = bringRing();
    if (good)
    {
      takeRing();
    }
  }
  surface_ = surface;
  surface_agrees_ = surface != nullptr && good && !on_surface_ && surfaceAgrees();
  return good;
}

SolveStatus JointDynamics::updateModel() noexcept
{
  SolveStatus result = ring_.updateModel();
  if (result.ok() &&
      (ring_.position().wave_generator_angle != motor_angle_ || ring_.position().output_angle != output_angle_))
  {
    result = ring_.reach(position()).addEffort(result);  // the last move of the ring had failed
  }
  viscosity_ = model_->bearing.viscosity(temperature_);
  takeRing();
  accept();  // energy that slip dissipates here counts as released by the change of the model
  return result;
}

/// Moves the full ring from its last position to the present angles of the joint on the surface. @returns false if the
/// ring has no equilibrium at these angles.
bool JointDynamics::bringRing() noexcept
{
  const SolveStatus brought = ring_.reach(position());
  status.iterations += brought.iterations;
  note(brought);
  return brought.ok();
}

void JointDynamics::note(const SolveStatus& solved) noexcept
{
  if (!solved.ok())
  {
    status.code = solved.code;
    status.stage = solved.stage;
  }
}

/// Makes the full ring's equilibrium the present equilibrium of the joint.
void JointDynamics::takeRing() noexcept
{
  friction_is_of_ring_ = false;
  const Eigen::Matrix2d& k = ring_.stiffness();
  const Eigen::Vector2d torques = ring_.torques();
  response_.energy = ring_.forces().energy;
  response_.wave_generator_torque = torques[0];
  response_.output_torque = torques[1];
  response_.velocity_ratio = ring_.velocityRatio();
  response_.output_stiffness = k(1, 1);
  response_.motor_stiffness = k(0, 0);
  motor_angle_ = ring_.position().wave_generator_angle;
  output_angle_ = ring_.position().output_angle;
  if (model_->cup_friction.hasState())
  {
    const RingRates rates{ ring_.shape(), ring_.byWaveGenerator(), ring_.byOutput() };
    turnCup(ring_.forces().of<CupTorsion>().rotation, rates.meanRotation());
  }
  slideShaft();
}

/// Updates the internal state of the friction for the present angles, with torques and stiffness from the surface.
void JointDynamics::takeSurface() noexcept
{
  friction_is_of_ring_ = false;
  if (model_->cup_friction.hasState())
  {
    // The torque between rim and housing twists the cup and so determines the rotation of the rim.
    const auto& cup = model_->ring.of<CupTorsion>();
    const double torque = -(response_.wave_generator_torque + response_.output_torque);
    turnCup(cup.rotationAtTorque(torque), housing_stiffness_ * cup.complianceAtTorque(torque));
  }
  slideShaft();
}

void JointDynamics::turnCup(double rotation, const Eigen::Vector2d& rates) noexcept
{
  now_.cup = model_->cup_friction.turned(accepted_.cup, rotation);
  cup_rates_ = rates;
}

void JointDynamics::slideShaft() noexcept
{
  const double angle = model_->motor.preslidingAngle();
  if (angle > 0.0)
  {
    now_.share = mobilised(accepted_.share, motor_angle_ - accepted_.motor_angle, angle);
    now_.motor_angle = motor_angle_;
  }
}

double JointDynamics::accept() noexcept
{
  if (!remembers_)
  {
    return 0.0;
  }
  const double slipped = now_.cup.slipped;
  now_.cup.slipped = 0.0;
  // A copy of all of `now_.cup` would be slow, because it waits for the last writes to `now_.cup`.
  accepted_.cup.twist = now_.cup.twist;
  accepted_.cup.rotation = now_.cup.rotation;
  if (model_->motor.preslidingAngle() > 0.0)
  {
    accepted_.share = now_.share;
    accepted_.motor_angle = now_.motor_angle;
  }
  if (model_->brake.hasPlay())
  {
    accepted_.pin = now_.pin;
  }
  return slipped;
}

/// Whether the present angles are well within the edges of the surface and the torques of surface and full ring agree
/// at these angles. After a jump of teeth they differ.
bool JointDynamics::surfaceAgrees() const noexcept
{
  constexpr double MARGIN = 0.05;   // least distance from the edges, as a share of the surface's range [-]
  constexpr double TABLED = 2e-6;   // largest error of a solved surface, as output angle at equal torque [rad]
  constexpr double BETWEEN = 2e-5;  // largest error of an interpolated surface; a jump of a tooth is 3e-2 [rad]
  ResponseSurface::Place place;
  if (!surface_->locate(motor_angle_, output_angle_, place) || surface_->nearEdge(place, MARGIN))
  {
    return false;
  }
  const double miss = surface_->response(place).output_torque - response_.output_torque;
  return std::abs(miss) <= (surface_->shares().empty() ? TABLED : BETWEEN) * response_.output_stiffness;
}

SolveStatus JointDynamics::placeRing(double motor_angle, double output_angle) noexcept
{
  const SolveStatus result = ring_.follow({ motor_angle, output_angle, model_->ring.gear.wave_amplitude });
  status.iterations += result.iterations;
  status.cuts += result.cuts;
  status.jumps += result.jumps;
  status.residual = result.residual;
  note(result);
  return result;
}

void JointDynamics::updateFriction(const Eigen::Vector2d& speeds) noexcept
{
  const JointModel::Running running{ speeds, brakeTorque(speeds[0]), viscosity() };
  if (on_surface_)
  {
    RingFrictionResponse ring_friction;
    surface_->friction(place_, ring_friction);
    Eigen::Vector2d cup_slip = cup_rates_;
    if (!model_->cup_friction.hasState())
    {
      const double torque = response_.wave_generator_torque + response_.output_torque;
      cup_slip = housing_stiffness_ * model_->ring.of<CupTorsion>().complianceAtTorque(torque);
    }
    model_->friction(ring_friction, cup_slip, running, friction_);
    return;
  }
  if (friction_is_of_ring_)
  {
    model_->frictionAt(running, friction_);
    return;
  }
  const RingRates rates{ ring_.shape(), ring_.byWaveGenerator(), ring_.byOutput() };
  model_->friction(ring_.forces(), rates, velocityRatio(), running, friction_);
  friction_is_of_ring_ = true;
}

/// Torque with which the brake holds the motor's shaft at the present angle [N.m].
double JointDynamics::brakeTorque(double motor_speed) noexcept
{
  now_.pin = accepted_.pin;
  const double push = motor_speed != 0.0 ? motor_speed : torque()[0];
  return model_->brake.hold(inputs.brake_engaged, motor_angle_, push, now_.pin);
}

double JointDynamics::viscosity() noexcept
{
  if (inputs.temperature != temperature_)
  {
    temperature_ = inputs.temperature;
    viscosity_ = model_->bearing.viscosity(temperature_);
  }
  return viscosity_;
}

KickedSpeeds JointDynamics::stopOrSlide(const DryFriction& friction, const Eigen::Vector2d& before,
                                        const Eigen::Vector2d& momentum, double dt) noexcept
{
  const KickedSpeeds speeds = friction.stopOrSlide(friction_, velocityRatio(), before, momentum, dt, sticking_);
  if (!speeds.solved)
  {
    status.code = speeds.after.allFinite() ? SolveCode::ITERATION_LIMIT : SolveCode::NOT_FINITE;
    status.stage = SolveStage::FRICTION;
    return { Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(), false };
  }
  return speeds;
}

void JointDynamics::operator()(const JointState& x, JointState& rate, double) noexcept
{
  using namespace joint_state;
  const Eigen::Vector2d speeds = x.segment<2>(MOTOR_SPEED);
  rate.setZero();
  if (!place(x[MOTOR_ANGLE], x[OUTPUT_ANGLE]).ok())
  {
    return;
  }
  // The torque of the current is a state of the joint if the current lags; else it is the limited command.
  drive_torque =
      model_->motor.currentRate() > 0.0 ? x[DRIVE_TORQUE] : model_->motor.limited(inputs.motor_torque, x[MOTOR_SPEED]);
  updateFriction(speeds);
  const Eigen::Vector2d drag = dry_.torque(friction_, velocityRatio(), speeds);
  rate.segment<2>(MOTOR_ANGLE) = speeds;
  const Eigen::Vector2d presliding(preslidingTorque(), 0.0);
  rate.segment<2>(MOTOR_SPEED) = (torque() + presliding + drag).cwiseQuotient(inertia_);
  rate[DRIVE_TORQUE] =
      model_->motor.currentRate() * (model_->motor.limited(inputs.motor_torque, speeds[0]) - x[DRIVE_TORQUE]);
  rate[MOTOR_WORK] = driveTorque() * speeds[0];
  rate[LOAD_WORK] = inputs.load() * speeds[1];
  rate[DISSIPATED] = -(drag + presliding).dot(speeds);
}
}  // namespace hjt
