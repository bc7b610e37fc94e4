// SPDX-License-Identifier: BSD-3-Clause
#include "elements/race_deflection.hpp"

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"

namespace hjt
{
namespace
{
using Bump = RaceDeflection::Drop;  // values 0 ... 1

/// Raised cosine of half width `half` at `angle` from its middle [rad]. `rate`: d(angle)/d(motor angle).
Bump bump(double angle, double rate, double half) noexcept
{
  const double x = std::remainder(angle, TWO_PI);
  if (std::abs(x) >= half)
  {
    return {};
  }
  const double scale = PI / half;
  const double c = 0.5 * std::cos(scale * x);
  const double s = 0.5 * std::sin(scale * x);
  return { 0.5 + c, -scale * rate * s, -scale * scale * rate * rate * c };
}
}  // namespace

RaceDeflection::RaceDeflection(const BearingParameters& bearing)
  : balls_(bearing.balls)
  , ball_diameter_(bearing.ball_diameter)
  , pitch_diameter_(bearing.pitch_diameter)
  , cage_rate_((1.0 - bearing.cage_slip) * 0.5 * (1.0 - ball_diameter_ / pitch_diameter_))
  , spin_rate_((1.0 - bearing.cage_slip) * 0.5 * (pitch_diameter_ / ball_diameter_ - ball_diameter_ / pitch_diameter_))
{
}

void RaceDeflection::add(const Spall& spall) noexcept
{
  if (size_ < spalls_.size())
  {
    spalls_[size_++] = spall;
  }
}

/// Depth by which a ball drops into a spall of `depth` and `length` [m].
double RaceDeflection::dropInto(double depth, double length) const noexcept
{
  return std::min(depth, length * length / (4.0 * ball_diameter_));
}

void RaceDeflection::addInnerSpall(double place, double depth, double length) noexcept
{
  add({ Where::INNER_RACE, 0, place, dropInto(depth, length), length / (pitch_diameter_ - ball_diameter_) });
}

void RaceDeflection::addOuterSpall(double place, double depth, double length) noexcept
{
  add({ Where::OUTER_RACE, 0, place, dropInto(depth, length), length / (pitch_diameter_ + ball_diameter_) });
}

void RaceDeflection::addBallSpall(int ball, double depth, double length) noexcept
{
  add({ Where::BALL, ball, 0.0, dropInto(depth, length), length / ball_diameter_ });
}

void RaceDeflection::addIdleBall(int ball, double depth) noexcept
{
  add({ Where::UNDER_BALL, ball, 0.0, depth, 0.0 });
}

double RaceDeflection::shareAt(double angle, double ball_pitch) noexcept
{
  return bump(angle, 0.0, ball_pitch).value;
}

double RaceDeflection::deepest() const noexcept
{
  double sum = 0.0;
  for (std::size_t k = 0; k < size_; ++k)
  {
    sum += spalls_[k].depth;
  }
  return sum;
}

bool RaceDeflection::dropsOneBall() const noexcept
{
  return size_ == 1 && (spalls_[0].where == Where::BALL || 2.0 * spalls_[0].half <= TWO_PI / balls_);
}

int RaceDeflection::ballThatMayDrop(double wave_generator_angle) const noexcept
{
  const Spall& spall = spalls_.front();
  if (spall.where == Where::BALL || spall.where == Where::UNDER_BALL)
  {
    return spall.ball;
  }
  const double moved = spall.where == Where::INNER_RACE ? wave_generator_angle : 0.0;
  const double nearest = (spall.place + moved - ballPlace(0, wave_generator_angle)) / TWO_PI;
  const int ball = static_cast<int>(std::lround((nearest - std::floor(nearest)) * balls_));
  return ball < balls_ ? ball : 0;
}

double RaceDeflection::ballPlace(int ball, double wave_generator_angle) const noexcept
{
  return TWO_PI * ball / balls_ + cage_rate_ * wave_generator_angle;
}

/// Drop of a ball into one spall, see RaceDeflection.
RaceDeflection::Drop RaceDeflection::drop(const Spall& spall, int ball, double angle) const noexcept
{
  // golden angle, by which the rotations of successive balls differ, so that the rotations have no pattern [rad]
  constexpr double GOLDEN = 2.399963229728653;
  Bump at;
  switch (spall.where)
  {
    case Where::INNER_RACE:
      at = bump(ballPlace(ball, angle) - angle - spall.place, cage_rate_ - 1.0, spall.half);
      break;
    case Where::OUTER_RACE:
      at = bump(ballPlace(ball, angle) - spall.place, cage_rate_, spall.half);
      break;
    case Where::BALL:
      if (ball == spall.ball)
      {
        const double turn = ball * GOLDEN - spin_rate_ * angle;
        const Bump outer = bump(turn, -spin_rate_, spall.half);
        const Bump inner = bump(turn - PI, -spin_rate_, spall.half);
        at = { outer.value + inner.value, outer.rate + inner.rate, outer.second + inner.second };
      }
      break;
    case Where::UNDER_BALL:
      at.value = ball == spall.ball ? 1.0 : 0.0;
      break;
  }
  return { spall.depth * at.value, spall.depth * at.rate, spall.depth * at.second };
}

RaceDeflection::Drop RaceDeflection::drop(int ball, double wave_generator_angle) const noexcept
{
  Drop sum;
  for (std::size_t k = 0; k < size_; ++k)
  {
    const Drop one = drop(spalls_[k], ball, wave_generator_angle);
    sum.value += one.value;
    sum.rate += one.rate;
    sum.second += one.second;
  }
  return sum;
}

void RaceDeflection::at(double wave_generator_angle, Eigen::VectorXd& sag, Eigen::VectorXd& rate,
                        Eigen::VectorXd& second) const noexcept
{
  sag.setZero();
  rate.setZero();
  second.setZero();
  const int teeth = static_cast<int>(sag.size());
  const double tooth_pitch = TWO_PI / teeth;
  const double ball_pitch = TWO_PI / balls_;
  const int reach = static_cast<int>(std::ceil(ball_pitch / tooth_pitch));
  for (int ball = 0; ball < balls_; ++ball)
  {
    const Drop sum = drop(ball, wave_generator_angle);
    if (sum.value == 0.0)
    {
      continue;
    }
    const double place = ballPlace(ball, wave_generator_angle);
    const int nearest = static_cast<int>(std::lround(std::remainder(place, TWO_PI) / tooth_pitch));
    for (int j = nearest - reach; j <= nearest + reach; ++j)
    {
      const int i = ((j % teeth) + teeth) % teeth;
      const Bump share = bump(i * tooth_pitch - place, -cage_rate_, ball_pitch);
      sag[i] += sum.value * share.value;
      rate[i] += sum.rate * share.value + sum.value * share.rate;
      second[i] += sum.second * share.value + 2.0 * sum.rate * share.rate + sum.value * share.second;
    }
  }
}
}  // namespace hjt
