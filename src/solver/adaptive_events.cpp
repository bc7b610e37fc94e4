// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/adaptive_stepper.hpp"

namespace hjt
{
using namespace joint_state;

namespace
{
int signOf(double value) noexcept
{
  return value > 0.0 ? 1 : value < 0.0 ? -1 : 0;
}
}  // namespace

/// Of a function that is positive at the start of the step and negative at `end`, by regula falsi (Illinois): a place
/// just behind its zero.
template <class Function>
double AdaptiveStepper::firstZero(Function&& function, double end, double at_start, double at_end) const noexcept
{
  constexpr int MOST = 40;
  constexpr double ENOUGH = 1e-9;  // of the step
  double low = 0.0;
  double high = end;
  int side = 0;
  for (int i = 0; i < MOST && high - low > ENOUGH * whole_; ++i)
  {
    const double share = std::clamp(at_start / (at_start - at_end), 1e-3, 0.999);
    const double middle = low + share * (high - low);
    const double value = function(middle);
    if (value < 0.0)
    {
      high = middle;
      at_end = value;
      at_start *= side < 0 ? 0.5 : 1.0;
      side = -1;
    }
    else
    {
      low = middle;
      at_start = value;
      at_end *= side > 0 ? 0.5 : 1.0;
      side = 1;
      if (value == 0.0)
      {
        return middle;
      }
    }
  }
  return high;
}

/// At the zero of a function that falls through it, if that is before the event so far. `begin`: gives its value at the
/// start, `whole`: that at the end of the whole step.
template <class Function, class Begin>
void AdaptiveStepper::endAt(const Function& function, const Begin& begin, double whole, Event& event) noexcept
{
  const double at_end = event.end < whole_ ? function(event.end) : whole;
  if (at_end < 0.0)
  {
    event = { firstZero(function, event.end, begin(), at_end), -1 };
    event_ = true;
  }
}

/// Motor or output comes to rest, or lets go of where it stood.
void AdaptiveStepper::endAtStop(int i, double excess, Event& event) noexcept
{
  State x;
  State rate;
  const int mode = mode_[static_cast<std::size_t>(i)];
  const double speed = mode * end_[MOTOR_SPEED + i];
  if (speed < 0.0 && (i == 0 || strength_[1] > 0.0))
  {
    const auto forward = [&](double time)
    {
      interpolate(time, x);
      return mode * x[MOTOR_SPEED + i];
    };
    const double at_end = event.end < whole_ ? forward(event.end) : speed;
    if (at_end >= 0.0)
    {
      return;
    }
    const double begin = std::max(mode * start_[MOTOR_SPEED + i], std::numeric_limits<double>::min());
    event = { firstZero(forward, event.end, begin, at_end), i };
    event_ = true;
  }
  else if (mode == 0 && excess > 0.0)
  {
    const auto held = [&](double time)
    {
      interpolate(time, x);
      (*this)(x, rate, time);
      return strength_[i] - std::abs(push_[i]);
    };
    endAt(
        held, [&] { return std::max(held(0.0), 0.0); }, -excess, event);
  }
}

/// The sliders are turned from end to end of a step. Where the rim goes beyond an end by more than counts, the step
/// ends there.
void AdaptiveStepper::endAtTurnOfTheRim(double turned, double stiffness, double by_output, Event& event) noexcept
{
  const double beyond = 0.5 * whole_ * std::min(std::abs(turned), std::abs(cup_rate_));
  const double kick = stiffness * by_output * beyond * whole_ / dynamics_->inertia()[1];
  if (!(turned * cup_rate_ < 0.0 && kick > speed_tolerance_))
  {
    return;
  }
  State x;
  const auto forward = [&](double time)
  {
    interpolate(time, x);
    return place(x) ? signOf(cup_rate_) * cupRate(x) : 0.0;
  };
  endAt(
      forward, [this] { return std::abs(cup_rate_); }, -std::abs(turned), event);
}

/// The drive begins or ceases to give less torque at its speed.
void AdaptiveStepper::endAtFade(Event& event) noexcept
{
  const double room = roomToFade(end_);
  if (!(start_[MOTOR_SPEED] * dynamics_->inputs.motor_torque > 0.0 && (fades_ ? room > 0.0 : room < 0.0)))
  {
    return;
  }
  State x;
  const auto left = [&](double time)
  {
    interpolate(time, x);
    return fades_ ? -roomToFade(x) : roomToFade(x);
  };
  endAt(
      left, [&] { return std::max(left(0.0), 0.0); }, -std::abs(room), event);
}

/// Ends the step at the first event in it, if there is one.
void AdaptiveStepper::endAtEvent() noexcept
{
  Event event{ whole_, -1 };
  const Eigen::Vector2d excess = push_.cwiseAbs() - strength_;
  const double turned = cupRate(end_);
  const double stiffness = dynamics_->cupStiffness();
  const double by_output = std::abs(dynamics_->cupRates()[1]);
  for (int i = 0; i < 2; ++i)
  {
    endAtStop(i, excess[i], event);
  }
  endAtTurnOfTheRim(turned, stiffness, by_output, event);
  endAtFade(event);
  if (event_)
  {
    interpolate(event.end, end_);
    length_ = event.end;
    next_ = std::min(next_, whole_);
    if (event.stopped >= 0)
    {
      end_[MOTOR_SPEED + event.stopped] = 0.0;
    }
  }
}
}  // namespace hjt
