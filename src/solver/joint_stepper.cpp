// SPDX-License-Identifier: BSD-3-Clause
#include "solver/joint_stepper.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/number_text.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
/// Mean magnitudes of the speeds over a kick (see Leapfrog), with the sign of `before`, for the strength of friction
/// [rad/s]. Speeds at the kick's beginning (`before`) and half a kick earlier (`earlier`) are extrapolated.
Eigen::Vector2d rubbingSpeeds(const Eigen::Vector2d& before, const Eigen::Vector2d& earlier) noexcept
{
  Eigen::Vector2d mean;
  for (int i = 0; i < 2; ++i)
  {
    const double from = std::abs(before[i]);
    const double to = 3.0 * before[i] - 2.0 * earlier[i];
    const bool turns = before[i] * to < 0.0;
    const double amount = turns ? 0.5 * (from * from + to * to) / (from + std::abs(to)) : 0.5 * (from + std::abs(to));
    mean[i] = from > 0.0 ? std::copysign(amount, before[i]) : 0.0;
  }
  return mean;
}

/// Speeds after a kick (see Leapfrog). `momentum`: momentum of motor and output after a kick without friction [N.m.s].
KickedSpeeds rub(JointDynamics& system, const DryFriction& friction, const Eigen::Vector2d& before,
                 const Eigen::Vector2d& momentum, double dt) noexcept
{
  Eigen::Vector2d after;
  if (system.onSurface() && friction.slide(system.friction(), system.velocityRatio(), before, momentum, dt, after))
  {
    return { after, 0.5 * (before + after) };
  }
  return system.stopOrSlide(friction, before, momentum, dt);
}

/// Speeds after a kick (see Leapfrog) in which the motor's torque decreases with the final speed, near the speed limit.
/// The solution is unique and does not overshoot, however steep the decrease is. `system` receives the motor's torque.
///
/// `others`: torques except those of motor and friction [N.m]; `kept`: part of the motor's last torque that the lagging
/// current keeps [N.m]; `share`: part of the wanted torque that the current reaches [-].
KickedSpeeds fade(JointDynamics& system, const Eigen::Vector2d& others, double kept, double share,
                  const Eigen::Vector2d& before, double dt) noexcept
{
  const Motor& motor = system.model().motor;
  const double wanted = system.inputs.motor_torque;
  const double gain = std::max(system.driveGain(), 0.0);
  const auto kick = [&](double torque, double slope)
  {
    // A torque that decreases with the final speed acts as additional inertia.
    Eigen::Vector2d inertia = system.inertia();
    const Eigen::Vector2d momentum = inertia.cwiseProduct(before) + dt * (others + Eigen::Vector2d(gain * torque, 0.0));
    inertia[0] += dt * gain * slope;
    return rub(system, system.dryFriction().withMotor(inertia[0]), before, momentum, dt);
  };
  KickedSpeeds speeds = kick(kept + share * motor.faded(wanted, 0.0), share * motor.fadeSlope(wanted));
  if (std::abs(speeds.after[0]) > motor.speedLimit())
  {
    speeds = kick(kept, 0.0);
  }
  system.drive_torque = kept + share * motor.faded(wanted, speeds.after[0]);
  return speeds;
}

/// Speeds after a kick by the torques `others` (see `fade`) and by the motor. The motor either has its whole torque
/// `full` [N.m] or reduces it by the speed at the kick's end. First the case at the kick's beginning is tried.
KickedSpeeds drive(JointDynamics& system, const Eigen::Vector2d& others, double full, double kept, double share,
                   const Eigen::Vector2d& before, double dt) noexcept
{
  const Motor& motor = system.model().motor;
  const double wanted = system.inputs.motor_torque;
  if (motor.fades(wanted, before[0]))
  {
    const KickedSpeeds faded = fade(system, others, kept, share, before, dt);
    if (motor.fades(wanted, faded.after[0]))
    {
      return faded;
    }
  }
  system.drive_torque = full;
  Eigen::Vector2d momentum = system.inertia().cwiseProduct(before) + dt * others;
  momentum[0] += dt * system.driveTorque();
  const KickedSpeeds speeds = rub(system, system.dryFriction(), before, momentum, dt);
  return motor.fades(wanted, speeds.after[0]) ? fade(system, others, kept, share, before, dt) : speeds;
}
}  // namespace

/// Speeds after a kick of length `dt` [s]. `rubbing`: speeds for the friction's strength [rad/s]; `lag`: part of the
/// motor's torque of the last kick that the lagging current keeps [-].
KickedSpeeds Leapfrog::kick(JointDynamics& system, JointState& x, const Eigen::Vector2d& before,
                            const Eigen::Vector2d& rubbing, double lag, double dt) noexcept
{
  const Eigen::Vector2d inertia = system.inertia();
  const double wanted = system.inputs.motor_torque;
  const double kept = lag * x[joint_state::DRIVE_TORQUE];
  const double full = wanted + lag * (x[joint_state::DRIVE_TORQUE] - wanted);
  system.drive_torque = full;
  system.updateFriction(rubbing);
  const double presliding = system.preslidingTorque();
  system.drive_torque = 0.0;
  Eigen::Vector2d torque = system.torque();
  torque[0] += presliding;
  const KickedSpeeds speeds = drive(system, torque, full, kept, 1.0 - lag, before, dt);
  torque[0] += system.driveTorque();
  const Eigen::Vector2d kicked = inertia.cwiseProduct(speeds.after - before) / dt;
  friction_ = kicked - torque;
  friction_[0] += presliding;
  link_torque_ = kicked[1] + system.inputs.load();
  x[joint_state::DRIVE_TORQUE] = system.drive_torque;
  inertia_ = inertia;
  acted_ = system.inputs;
  return speeds;
}

/// Whether a jump of the inputs since the last kick requires `retake`. A lagging current does not jump with the
/// command. The arm's torque is not compared, because it belongs to the end of a step.
bool Leapfrog::actOtherwise(const JointDynamics& system) const noexcept
{
  const JointInputs& now = system.inputs;
  return !moves_ || (now.motor_torque != acted_.motor_torque && system.model().motor.currentRate() == 0.0) ||
         now.load_torque != acted_.load_torque || now.brake_engaged != acted_.brake_engaged;
}

void Leapfrog::do_step(JointDynamics& system, JointState& x, double, double dt) noexcept
{
  using namespace joint_state;
  if (actOtherwise(system))
  {
    retake(system, x, dt);
  }
  const Eigen::Vector2d before = x.segment<2>(MOTOR_SPEED);
  const Eigen::Vector2d angles = x.segment<2>(MOTOR_ANGLE) + dt * before;
  if (!system.place(angles[0], angles[1]).ok())
  {
    stop(system, x);
    return;
  }
  const Eigen::Vector2d inertia = system.inertia();
  const double slipped = system.accept();
  const KickedSpeeds kicked =
      kick(system, x, before, rubbingSpeeds(before, halfway_), system.model().motor.currentLeft(dt), dt);
  const Eigen::Vector2d& after = kicked.after;
  speeds_ = 0.5 * (before + after);
  halfway_ = kicked.halfway;
  half_kick_ = after - speeds_;
  x.segment<2>(MOTOR_ANGLE) = angles;
  x.segment<2>(MOTOR_SPEED) = after;

  // The works of the first half of the kick belong before the instant of the angles, those of the second half after it.
  // The only error of the energy account is then the quadrature.
  const Eigen::Vector3d until = works(system, before, dt);
  rest_ = works(system, after, dt);
  x[DISSIPATED] += slipped;
  const Eigen::Vector2d kinetic = 0.5 * inertia.cwiseProduct(before.cwiseProduct(after)) - retaken_;
  balance_ = x[MOTOR_WORK] - x[LOAD_WORK] - x[DISSIPATED] + until[0] - until[1] - until[2] - kinetic.sum();
  delivered_ = x[LOAD_WORK] + until[1] + kinetic[1];
  x.segment<3>(MOTOR_WORK) += until + rest_;
}

/// Works of motor, load and friction in the last kick over half a step at `speeds`, in the order of the state [J].
Eigen::Vector3d Leapfrog::works(const JointDynamics& system, const Eigen::Vector2d& speeds, double dt) const noexcept
{
  return 0.5 * dt *
         Eigen::Vector3d(system.driveTorque() * speeds[0], system.inputs.load() * speeds[1], -friction_.dot(speeds));
}

void Leapfrog::retake(JointDynamics& system, JointState& x, double dt) noexcept
{
  using namespace joint_state;
  const Eigen::Vector2d inertia = system.inertia();
  if (!moves_)
  {
    moves_ = true;
    speeds_ = x.segment<2>(MOTOR_SPEED);
    halfway_ = speeds_;
    half_kick_.setZero();
    rest_.setZero();
    inertia_ = inertia;
  }
  x.segment<3>(MOTOR_WORK) -= rest_;
  retaken_ += 0.5 * inertia_.cwiseProduct(half_kick_.cwiseAbs2());
  // The works were computed with the mean speed of the kick. If a friction term stopped within the kick, the speed in
  // the middle of the kick differs from this mean.
  x[DISSIPATED] += 0.5 * inertia_.dot(speeds_.cwiseAbs2() - halfway_.cwiseAbs2());
  // If an arm changed the output's inertia, the kinetic energy changed at the speeds that `retake` undoes.
  x[LOAD_WORK] += 0.5 * (inertia - inertia_).dot(x.segment<2>(MOTOR_SPEED).cwiseAbs2() - halfway_.cwiseAbs2());
  speeds_ = halfway_;

  const double half = 0.5 * dt;
  const double arm_torque = system.inputs.arm_torque;
  system.inputs.arm_torque = acted_.arm_torque;
  const bool lags = system.model().motor.currentRate() > 0.0;
  const Eigen::Vector2d after = kick(system, x, speeds_, speeds_, lags ? 1.0 : 0.0, half).after;
  half_kick_ = after - speeds_;
  retaken_ -= 0.5 * inertia.cwiseProduct(half_kick_.cwiseAbs2());
  rest_ = works(system, after, dt);
  x.segment<2>(MOTOR_SPEED) = after;
  x.segment<3>(MOTOR_WORK) += rest_;
  system.inputs.arm_torque = arm_torque;
}

/// Sets the joint to rest at its last angles.
void Leapfrog::stop(const JointDynamics& system, JointState& x) noexcept
{
  using namespace joint_state;
  x.segment<3>(MOTOR_WORK) -= rest_;
  const Eigen::Vector2d kinetic =
      0.5 * system.inertia().cwiseProduct(speeds_.cwiseAbs2() - half_kick_.cwiseAbs2()) - retaken_;
  x[DISSIPATED] += kinetic.sum();
  x.segment<2>(MOTOR_SPEED).setZero();
  speeds_.setZero();
  retaken_.setZero();
  rest_.setZero();
  moves_ = false;
  balance_ = x[MOTOR_WORK] - x[LOAD_WORK] - x[DISSIPATED];
  delivered_ = x[LOAD_WORK];
}

using namespace joint_state;

namespace
{
// wanted phase of a substep over `phase_limit_` [-]; below 1, because friction under load stiffens the joint
constexpr double AIM = 0.8;
}  // namespace

JointStepper::JointStepper(const Parameters& parameters, const JointModel& model)
  : step_(1.0 / parameters.solver.rate), substep_(step_), dynamics_(model, parameters.solver)
{
  if (!reset())
  {
    throw ParameterError(
        "the gear has no equilibrium with these parameters: the insertion of the wave generator did not converge "
        "(largest remaining force " +
        roundedText(dynamics_.status.residual, 6) + " N). Check gear.*, ring.*, contact.*, mesh.* and cup.*");
  }
  prepareDivision(parameters);
  const double fastest = frequency(dynamics_.inertia()[1]);
  const double longest = MAX_SUBSTEPS * AIM * phase_limit_;
  if (fastest * step_ > longest)
  {
    TextStream text;
    text << "solver.rate = " << parameters.solver.rate << " Hz is too low. With inertias of " << dynamics_.inertia()[0]
         << " kg.m^2 at the motor and " << dynamics_.inertia()[1] << " kg.m^2 at the output the joint can oscillate at "
         << fastest << " rad/s. Raise solver.rate to at least " << fastest / longest
         << " Hz, or raise output.load_inertia, cup.friction_angle or motor.presliding_angle";
    throw ParameterError(text.str());
  }
  substeps_ = substepsFor(fastest * step_);
  substep_ = step_ / substeps_;
}

void JointStepper::prepareDivision(const Parameters& parameters) noexcept
{
  const double motor = dynamics_.inertia()[0];
  const std::array<double, 3>& slopes = parameters.cup.torsion_stiffness;
  stiffest_ = *std::max_element(slopes.begin(), slopes.end()) + dynamics_.model().cup_friction.stiffness();
  const double ratio = nominalRatio(parameters.gear);
  motor_square_ = stiffest_ / (motor * ratio * ratio) + dynamics_.model().motor.coggingStiffness() / motor;
  if (parameters.motor.presliding_angle > 0.0)
  {
    // The friction is stiffest after a reversal from full friction.
    dynamics_.updateFriction({ 0.0, 0.0 });
    motor_square_ += 2.0 * dynamics_.friction().presliding / parameters.motor.presliding_angle / motor;
  }
}

/// Angular frequency of the fastest oscillation of motor against output, on the stiffest slope of the cup [rad/s].
double JointStepper::frequency(double output_inertia) const noexcept
{
  return std::sqrt(stiffest_ / output_inertia + motor_square_);
}

/// Number of substeps. `phase`: phase of the fastest oscillation of motor against output in an undivided step [rad].
int JointStepper::substepsFor(double phase) const noexcept
{
  constexpr double LENGTH = 1e-4;  // longest substep of a divided step that suits contacts and friction [s]
  if (phase <= phase_limit_)
  {
    return 1;
  }
  const double wanted = std::max(phase / (AIM * phase_limit_), step_ / LENGTH);
  const int least = static_cast<int>(std::ceil(std::min<double>(wanted, MAX_SUBSTEPS) * (1.0 - 1e-12)));
  return least + (least % 2 == 0 ? 1 : 0);
}

bool JointStepper::useSurface(const ResponseSurface* surface) noexcept
{
  rest_steps_ = 0;
  return dynamics_.useSurface(surface);
}

bool JointStepper::reset(double arm_torque) noexcept
{
  dynamics_.inputs = {};
  dynamics_.inputs.arm_torque = arm_torque;
  dynamics_.drive_torque = 0.0;
  const bool settled = dynamics_.solveAtRest().ok();
  x_.setZero();
  x_[OUTPUT_ANGLE] = dynamics_.outputAngle();
  speeds_.setZero();
  friction_.setZero();
  balance_ = 0.0;
  leapfrog_.reset(arm_torque);
  rest_steps_ = 0;
  throughput_ = 0.0;
  released_ = 0.0;
  stored_at_start_ = dynamics_.storedEnergy();
  return settled;
}

void JointStepper::setOutputInertia(double inertia) noexcept
{
  if (phase_limit_ != MAX_PHASE_ADVANCE_IN_ARM || inertia != dynamics_.inertia()[1])
  {
    phase_limit_ = MAX_PHASE_ADVANCE_IN_ARM;
    divideAgain(inertia);
  }
  // The output keeps its speed, so the change of its kinetic energy is the work of the arm.
  const double speed = x_[OUTPUT_SPEED];
  x_[LOAD_WORK] -= 0.5 * (inertia - dynamics_.inertia()[1]) * speed * speed;
  dynamics_.setOutputInertia(inertia);
}

/// Raises the number of substeps if their phase exceeds `phase_limit_`. Reduces it if fewer substeps meet AIM.
void JointStepper::divideAgain(double output_inertia) noexcept
{
  const double phase = frequency(output_inertia) * step_;
  const int wanted = substepsFor(phase);
  const bool too_few = phase > substeps_ * phase_limit_;
  const bool too_many = wanted < substeps_ && phase <= wanted * AIM * phase_limit_;
  if (too_few || too_many)
  {
    substeps_ = wanted;
    substep_ = step_ / substeps_;
    leapfrog_.retake(dynamics_, x_, substep_);
  }
}

bool JointStepper::staysAtRest(const JointInputs& inputs) const noexcept
{
  constexpr double SETTLED = 1e-9;  // torque of the current minus the wanted torque, relative to the wanted torque [-]
  const JointInputs& last = dynamics_.inputs;
  return rest_steps_ * step_ >= REST_TIME && inputs.motor_torque == last.motor_torque &&
         std::abs(x_[DRIVE_TORQUE] - inputs.motor_torque) <= SETTLED * std::abs(inputs.motor_torque) &&
         inputs.load_torque == last.load_torque && inputs.arm_torque == last.arm_torque &&
         inputs.brake_engaged == last.brake_engaged && inputs.temperature == last.temperature;
}

bool JointStepper::updateModel() noexcept
{
  const double stored = dynamics_.storedEnergy();
  const bool good = dynamics_.updateModel().ok();
  released_ += stored - dynamics_.storedEnergy();
  leapfrog_.retake(dynamics_, x_, substep_);
  return good;
}

bool JointStepper::step(const JointInputs& inputs) noexcept
{
  if (staysAtRest(inputs))
  {
    dynamics_.status.iterations = 0;
    return true;
  }
  dynamics_.status = {};
  bool good = true;
  const double arm_torque = dynamics_.inputs.arm_torque;
  dynamics_.inputs = inputs;
  for (int i = 0; good && i < substeps_; ++i)
  {
    dynamics_.inputs.arm_torque = i < substeps_ / 2 ? arm_torque : inputs.arm_torque;
    good = substep();
  }
  dynamics_.inputs = inputs;
  const bool rests = good && x_[MOTOR_SPEED] == 0.0 && std::abs(x_[OUTPUT_SPEED]) <= REST_SPEED;
  rest_steps_ = rests ? rest_steps_ + 1 : 0;
  return good;
}

bool JointStepper::substep() noexcept
{
  const Eigen::Vector3d work = x_.segment<3>(MOTOR_WORK);
  leapfrog_.do_step(dynamics_, x_, 0.0, substep_);
  speeds_ = leapfrog_.speeds();
  friction_ = leapfrog_.frictionTorque();
  balance_ = leapfrog_.balance();
  throughput_ += (x_.segment<3>(MOTOR_WORK) - work).lpNorm<1>();
  return dynamics_.status.ok();
}

/// Squared angular frequencies of the motor with the output held, and of the output with the motor held [rad^2/s^2].
Eigen::Vector2d JointStepper::swingSquares() const noexcept
{
  const RingResponse& ring = dynamics_.response();
  const Eigen::Vector2d friction = dynamics_.frictionStiffness().diagonal();
  return (Eigen::Vector2d(ring.motor_stiffness + dynamics_.model().motor.coggingStiffness(), ring.output_stiffness) +
          friction)
      .cwiseQuotient(dynamics_.inertia());
}

double JointStepper::phaseAdvance() const noexcept
{
  const RingResponse& ring = dynamics_.response();
  const Eigen::Vector2d squares = swingSquares();
  const double cross = ring.velocity_ratio * ring.output_stiffness - dynamics_.frictionStiffness()(0, 1);
  const double fastest = 0.5 * squares.sum() + std::sqrt(0.25 * (squares[0] - squares[1]) * (squares[0] - squares[1]) +
                                                         cross * cross / dynamics_.inertia().prod());
  return substep_ * std::sqrt(std::max(fastest, 0.0));
}

bool JointStepper::isCoarse() const noexcept
{
  // swingSquares().sum() is an upper bound of the squared frequency, so that most calls do not need phaseAdvance().
  return substep_ * substep_ * swingSquares().sum() > phase_limit_ * phase_limit_ && phaseAdvance() > phase_limit_;
}

double JointStepper::energyResidual() const noexcept
{
  return balance_ - (dynamics_.storedEnergy() - stored_at_start_) - released_;
}
}  // namespace hjt
