// SPDX-License-Identifier: BSD-3-Clause
#include "elements/single_balls.hpp"

#include <cmath>

#include "elements/hertz_contact.hpp"
#include "gear/angle.hpp"

namespace hjt
{
SingleBalls::SingleBalls(double stiffness, int teeth) : stiffness_(stiffness), tooth_pitch_(TWO_PI / teeth) {}

double SingleBalls::press(const RaceDeflection& bearing, double wave_generator_angle, const Eigen::VectorXd& depth,
                          Scratch& scratch, Eigen::VectorXd& force, double& torque) const noexcept
{
  const auto teeth = static_cast<int>(depth.size());
  const double rate = bearing.cageRate() / tooth_pitch_;
  double energy = 0.0;
  force.setZero();
  for (int b = 0; b < bearing.balls(); ++b)
  {
    Ball& ball = scratch.balls[static_cast<std::size_t>(b)];
    const double place = std::remainder(bearing.ballPlace(b, wave_generator_angle), TWO_PI) / tooth_pitch_;
    const double nearest = std::round(place);
    const double t = place - nearest;
    const int middle = (static_cast<int>(nearest) + teeth) % teeth;
    ball.tooth = { (middle + teeth - 1) % teeth, middle, (middle + 1) % teeth };
    ball.weight = { 0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t) };
    ball.rate = { (t - 0.5) * rate, -2.0 * t * rate, (t + 0.5) * rate };
    ball.second = { rate * rate, -2.0 * rate * rate, rate * rate };
    ball.drop = bearing.drop(b, wave_generator_angle);
    double pressed = -ball.drop.value;
    double along = -ball.drop.rate;
    for (std::size_t k = 0; k < 3; ++k)
    {
      pressed += ball.weight[k] * depth[ball.tooth[k]];
      along += ball.rate[k] * depth[ball.tooth[k]];
    }
    const HertzContact contact(pressed);
    ball.depth = pressed;
    ball.force = stiffness_ * contact.force;
    ball.slope = stiffness_ * contact.tangent;
    energy += stiffness_ * contact.energy;
    torque -= ball.force * along;
    for (std::size_t k = 0; k < 3; ++k)
    {
      force[ball.tooth[k]] += ball.weight[k] * ball.force;
    }
  }
  return energy;
}

void SingleBalls::addTangent(const RaceDeflection& bearing, const RingShape& shape, const Eigen::VectorXd& depth,
                             const Eigen::VectorXd& normal, const Scratch& scratch, RingTangent& tangent) const noexcept
{
  for (int b = 0; b < bearing.balls(); ++b)
  {
    const Ball& ball = scratch.balls[static_cast<std::size_t>(b)];
    if (ball.force == 0.0)
    {
      continue;
    }
    std::array<Eigen::Vector2d, 3> push;  // by how much the depth falls with each tooth point [-]
    double by_angle = -ball.drop.rate;
    double by_angle_twice = -ball.drop.second;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int i = ball.tooth[k];
      const Eigen::Vector2d n = normal.segment<2>(2 * i);
      const double lever = shape.points[2 * i] * n.y() - shape.points[2 * i + 1] * n.x();
      push[k] = ball.weight[k] * n;
      by_angle += ball.weight[k] * lever + ball.rate[k] * depth[i];
      by_angle_twice += 2.0 * ball.rate[k] * lever + ball.second[k] * depth[i];
    }
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int i = ball.tooth[k];
      tangent.addDiagonal(i, ball.slope * push[k] * push[k].transpose());
      for (std::size_t m = k + 1; m < 3; ++m)
      {
        tangent.addPair(i, ball.tooth[m], ball.slope * push[k] * push[m].transpose());
      }
      tangent.wave_generator.segment<2>(2 * i) -=
          ball.slope * by_angle * push[k] + ball.force * ball.rate[k] * normal.segment<2>(2 * i);
    }
    tangent.wave_generator_stiffness += ball.slope * by_angle * by_angle + ball.force * by_angle_twice;
  }
}
}  // namespace hjt
