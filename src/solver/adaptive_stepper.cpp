// SPDX-License-Identifier: BSD-3-Clause
#include "solver/adaptive_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace hjt
{
using namespace joint_state;

namespace
{
constexpr double SHORTEST = 1e-10;    // step [s]
constexpr double FIRST_PHASE = 0.15;  // of the step tried after a start [rad]
constexpr int MOST_STEPS = 10000;     // to an instant

int signOf(double value) noexcept
{
  return value > 0.0 ? 1 : value < 0.0 ? -1 : 0;
}

Eigen::Vector4d perUnit(double tolerance, double ratio, double frequency) noexcept
{
  return Eigen::Vector4d(ratio, 1.0, ratio * frequency, frequency).cwiseInverse() / tolerance;
}
}  // namespace

AdaptiveStepper::AdaptiveStepper(JointDynamics& dynamics, double tolerance, double ratio, double frequency) noexcept
  : dynamics_(&dynamics)
  , controlled_(ErrorChecker{ perUnit(tolerance, ratio, frequency) },
                boost::numeric::odeint::default_step_adjuster<double, double>(MAX_PHASE / frequency))
  , speed_tolerance_(tolerance * frequency)
  , first_(FIRST_PHASE / frequency)
{
}

bool AdaptiveStepper::covers(const JointInputs& inputs) const noexcept
{
  const JointModel& model = dynamics_->model();
  return !model.cup_friction.isTerm() && !(model.brake.hasPlay() && inputs.brake_engaged);
}

void AdaptiveStepper::start(JointState& x) noexcept
{
  x[DISSIPATED] += dynamics_->accept();
  x[DRIVE_TORQUE] = dynamics_->drive_torque = dynamics_->explicitDriveTorque(x);
  end_ = x;
  start_ = x;
  at_ = 0.0;
  length_ = 0.0;
  next_ = first_;
  event_ = true;
  fades_ = false;
  lag_ = 0.0;
}

bool AdaptiveStepper::advance(double length, JointState& x, double& left) noexcept
{
  steps_ = 0;
  at_ += length;
  while (at_ > length_)
  {
    at_ -= length_;
    if (steps_ == MOST_STEPS || !takeStep())
    {
      x = steps_ == MOST_STEPS ? end_ : start_;
      x[DRIVE_TORQUE] = dynamics_->drive_torque;
      left = at_;
      return false;
    }
  }
  interpolate(at_, x);
  State unused;
  (*this)(x, unused, at_);
  x[DRIVE_TORQUE] = dynamics_->drive_torque;
  left = 0.0;
  return true;
}

/// The next step, from the end of the one before.
bool AdaptiveStepper::takeStep() noexcept
{
  if (!place(end_))
  {
    start_ = end_;
    return false;
  }
  cup_rate_ = cupRate(end_);
  end_[DISSIPATED] += dynamics_->accept();
  lag_ += length_;
  if (event_)
  {
    end_[DRIVE_TORQUE] = currentTorque(end_, 0.0);
    lag_ = 0.0;
  }
  start_ = end_;
  if (event_)
  {
    chooseModes();
    event_ = false;
  }
  start_rate_ = end_rate_;
  if (isAtRest())
  {
    length_ = whole_ = std::numeric_limits<double>::infinity();
    return true;
  }
  double time = 0.0;
  while (time == 0.0)
  {
    const double tried = next_;
    left_surface_ = false;
    const bool good = controlled_.try_step(std::ref(*this), start_, start_rate_, time, end_, end_rate_, next_) ==
                          boost::numeric::odeint::success &&
                      !left_surface_ && end_.allFinite();
    if (left_surface_)
    {
      next_ = 0.25 * tried;
    }
    if (!good)
    {
      time = 0.0;
      if (!(next_ > SHORTEST))
      {
        return false;
      }
    }
  }
  ++steps_;
  whole_ = length_ = time;
  endAtEvent();
  return true;
}

/// Which way motor and output slide on from the start of a step, and the rates there.
void AdaptiveStepper::chooseModes() noexcept
{
  mode_ = { signOf(start_[MOTOR_SPEED]), signOf(start_[OUTPUT_SPEED]) };
  fades_ = dynamics_->model().motor.fades(dynamics_->inputs.motor_torque, start_[MOTOR_SPEED]);
  (*this)(start_, end_rate_, 0.0);
  for (int i = 0; i < 2; ++i)
  {
    if (start_[MOTOR_SPEED + i] == 0.0 && std::abs(push_[i]) > strength_[i])
    {
      mode_[static_cast<std::size_t>(i)] = signOf(push_[i]);
      (*this)(start_, end_rate_, 0.0);
    }
  }
}

void AdaptiveStepper::interpolate(double time, JointState& x) const noexcept
{
  if (time >= length_ || time <= 0.0 || !std::isfinite(whole_))
  {
    x = time > 0.0 ? end_ : start_;
    return;
  }
  controlled_.stepper().calc_state(time, x, start_, start_rate_, 0.0, end_, end_rate_, whole_);
}

bool AdaptiveStepper::place(const JointState& x) noexcept
{
  return dynamics_->placeOnSurface(x[MOTOR_ANGLE], x[OUTPUT_ANGLE]);
}

/// Of the rim, at the ring in place [rad/s].
double AdaptiveStepper::cupRate(const JointState& x) const noexcept
{
  return dynamics_->cupRates().dot(x.segment<2>(MOTOR_SPEED));
}

/// Up to where the drive's torque fades [rad/s].
double AdaptiveStepper::roomToFade(const JointState& x) const noexcept
{
  return dynamics_->model().motor.fadeSpeed() - std::abs(x[MOTOR_SPEED]);
}

/// Of the drive's current, `time` after the start of the step.
double AdaptiveStepper::currentTorque(const JointState& x, double time) const noexcept
{
  const Motor& motor = dynamics_->model().motor;
  const double wanted = dynamics_->inputs.motor_torque;
  if (fades_)
  {
    return motor.currentRate() > 0.0 ? x[DRIVE_TORQUE] : motor.faded(wanted, x[MOTOR_SPEED]);
  }
  return wanted + motor.currentLeft(lag_ + time) * (x[DRIVE_TORQUE] - wanted);
}

/// Motor and output stick, and nothing changes.
bool AdaptiveStepper::isAtRest() const noexcept
{
  constexpr double SETTLED = 1e-12;
  return mode_[0] == 0 && mode_[1] == 0 && dynamics_->model().motor.currentLeft(lag_) < SETTLED;
}

void AdaptiveStepper::operator()(const JointState& x, JointState& rate, double time) noexcept
{
  rate.setZero();
  dynamics_->drive_torque = currentTorque(x, time);
  if (!place(x))
  {
    left_surface_ = true;
    return;
  }
  const Eigen::Vector2d speeds = x.segment<2>(MOTOR_SPEED);
  dynamics_->updateFriction(speeds);
  const JointFriction& friction = dynamics_->friction();
  const double follow = std::abs(dynamics_->velocityRatio());
  const bool motor_sticks = mode_[0] == 0;
  strength_.setZero();
  Eigen::Vector2d drag = -(friction.viscous * speeds);
  drag[0] += dynamics_->preslidingTorque();
  for (const FrictionTerm term : friction.terms)
  {
    if (term.slip[1] == 0.0)
    {
      strength_[0] += term.strength * std::abs(term.slip[0]);
    }
    else if (term.slip[0] == 0.0)
    {
      strength_[1] += term.strength * std::abs(term.slip[1]);
    }
    else if (motor_sticks)
    {
      // A flank that the output drags along pushes the motor; one at rest helps to hold it.
      strength_[1] += term.strength * std::abs(term.slip[1]);
      strength_[0] += mode_[1] == 0 ? term.strength * std::abs(term.slip[0]) : 0.0;
      drag[0] -= mode_[1] * signOf(term.slip[1]) * term.strength * term.slip[0];
    }
    else
    {
      const double slip = term.slip.dot(speeds);
      const double width = FLANK_WIDTH * (std::abs(term.slip[0]) + follow * std::abs(term.slip[1]));
      drag -= (term.strength * slip / std::sqrt(slip * slip + width * width)) * term.slip;
    }
  }
  const Eigen::Vector2d torque = dynamics_->torque();
  push_ = torque + drag;
  for (int i = 0; i < 2; ++i)
  {
    const int mode = mode_[static_cast<std::size_t>(i)];
    drag[i] -= mode != 0 ? mode * strength_[i] : std::clamp(push_[i], -strength_[i], strength_[i]);
    rate[MOTOR_ANGLE + i] = speeds[i];
    rate[MOTOR_SPEED + i] = mode != 0 ? (torque[i] + drag[i]) / dynamics_->inertia()[i] : 0.0;
  }
  rate[MOTOR_WORK] = dynamics_->driveTorque() * speeds[0];
  rate[LOAD_WORK] = dynamics_->inputs.load_torque * speeds[1];
  rate[DISSIPATED] = -drag.dot(speeds);
  if (fades_)
  {
    const Motor& motor = dynamics_->model().motor;
    rate[DRIVE_TORQUE] =
        motor.currentRate() * (motor.faded(dynamics_->inputs.motor_torque, speeds[0]) - x[DRIVE_TORQUE]);
  }
  drag_ = drag;
}
}  // namespace hjt
