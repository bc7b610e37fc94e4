// SPDX-License-Identifier: BSD-3-Clause
#include "solver/joint_stepper.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/number_text.hpp"
#include "base/text_stream.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
using namespace joint_state;

namespace
{
constexpr double AIM = 0.8;  // share of the phase limit for a substep: friction under load stiffens the joint [-]
}  // namespace

JointStepper::JointStepper(const Parameters& parameters, const JointModel& model)
  : step_(1.0 / parameters.solver.rate), substep_(step_), dynamics_(model, parameters.solver)
{
  if (!reset())
  {
    throw ParameterError(
        "these parameters have no equilibrium: the insertion of the wave generator did not converge "
        "(gear.*, ring.*, contact.*, mesh.*, cup.*; largest force left " +
        roundedText(dynamics_.status.residual, 6) + " N)");
  }
  prepareDivision(parameters);
  const double fastest = frequency(dynamics_.inertia()[1]);
  const double longest = MAX_SUBSTEPS * AIM * phase_limit_;
  if (fastest * step_ > longest)
  {
    TextStream text;
    text << "solver.rate = " << parameters.solver.rate << " Hz is too low: with inertias of " << dynamics_.inertia()[0]
         << " kg.m^2 at the motor and " << dynamics_.inertia()[1] << " kg.m^2 at the output the joint can swing at "
         << fastest << " rad/s, which needs at least " << fastest / longest
         << " Hz (or a larger output.load_inertia, cup.friction_angle or motor.presliding_angle)";
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
    // Just after a reversal, from full friction.
    dynamics_.updateFriction({ 0.0, 0.0 });
    motor_square_ += 2.0 * dynamics_.friction().presliding / parameters.motor.presliding_angle / motor;
  }
}

/// Of the fastest motion: output and motor, reduced to the joint, swing against each other on the stiffest slope of the
/// cup [rad/s].
double JointStepper::frequency(double output_inertia) const noexcept
{
  return std::sqrt(stiffest_ / output_inertia + motor_square_);
}

/// `phase`: of that swing in a step [rad].
int JointStepper::substepsFor(double phase) const noexcept
{
  constexpr double LENGTH = 1e-4;  // longest substep that contacts and friction allow at any swing [s]
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
  // The speed stays, and with it the energy of the output changes: what the arm does to it.
  const double speed = x_[OUTPUT_SPEED];
  x_[LOAD_WORK] -= 0.5 * (inertia - dynamics_.inertia()[1]) * speed * speed;
  dynamics_.setOutputInertia(inertia);
}

/// More substeps once the phase is beyond its limit, fewer once fewer have it where it is aimed at.
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
  constexpr double SETTLED = 1e-9;  // share of the wanted torque by which the current may differ
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

/// Of motor and of output, each with the other held: squares of the angular frequencies [rad^2/s^2].
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
  // The square of the fastest swing is at most the sum of the squares.
  return substep_ * substep_ * swingSquares().sum() > phase_limit_ * phase_limit_ && phaseAdvance() > phase_limit_;
}

double JointStepper::energyResidual() const noexcept
{
  return balance_ - (dynamics_.storedEnergy() - stored_at_start_) - released_;
}
}  // namespace hjt
