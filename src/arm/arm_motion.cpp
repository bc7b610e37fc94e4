// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "arm/check_up.hpp"

namespace hjt
{
void ArmMotion::goOn(double time, const std::vector<JointMotion>& joints) noexcept
{
  // A move without a pause changes the last one.
  if (goes_on_ && time > end())
  {
    std::swap(points_[0], points_[1]);
  }
  goes_on_ = true;
  points_[1].time = time;
  points_[1].joints = joints;
}

void ArmMotion::at(double time, std::vector<JointMotion>& motion) noexcept
{
  if (repeats_ && time > end())
  {
    time = begin() + std::fmod(time - begin(), end() - begin());
  }
  if (time <= begin() || time >= end())
  {
    const ArmSetPoint& point = time <= begin() ? points_.front() : points_.back();
    const bool moves = goes_on_ || time == point.time;
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      motion[i] = moves ? point.joints[i] : JointMotion{ point.joints[i].position, 0.0, 0.0 };
    }
    return;
  }
  last_ = points_[last_].time > time ? 0 : last_;
  while (points_[last_ + 1].time <= time)
  {
    ++last_;
  }
  const ArmSetPoint& from = points_[last_];
  const ArmSetPoint& to = points_[last_ + 1];
  const double length = to.time - from.time;
  const double s = (time - from.time) / length;
  for (std::size_t i = 0; i < motion.size(); ++i)
  {
    const JointMotion& a = from.joints[i];
    const JointMotion& b = to.joints[i];
    const double way = b.position - a.position;
    // Hermite's cubic by its derivatives at both ends.
    const double c2 = 3.0 * way - length * (2.0 * a.velocity + b.velocity);
    const double c3 = length * (a.velocity + b.velocity) - 2.0 * way;
    motion[i].position = a.position + s * (length * a.velocity + s * (c2 + s * c3));
    motion[i].velocity = a.velocity + s * (2.0 * c2 + 3.0 * s * c3) / length;
    motion[i].acceleration = accelerations_ == ArmAccelerations::GIVEN ?
                                 a.acceleration + s * (b.acceleration - a.acceleration) :
                                 (2.0 * c2 + 6.0 * s * c3) / (length * length);
  }
}

std::vector<ArmSetPoint> fromRest(const ArmSetPoint& point)
{
  constexpr double STILL = 1e-3;        // [rad/s]
  constexpr double ACCELERATION = 2.0;  // mean, of the fastest joint [rad/s^2]
  constexpr double SHORTEST = 0.2;      // [s]
  constexpr std::size_t STEPS = 32;
  double fastest = 0.0;
  for (const JointMotion& joint : point.joints)
  {
    fastest = std::max(fastest, std::abs(joint.velocity));
  }
  if (fastest <= STILL)
  {
    return { point };
  }
  const double length = std::max(fastest / ACCELERATION, SHORTEST);
  std::vector<ArmSetPoint> points(STEPS + 1, point);
  for (std::size_t k = 0; k < STEPS; ++k)
  {
    // Speed a cubic of the time's share s, at rest without acceleration at 0, the point's own at 1.
    const double s = static_cast<double>(k) / static_cast<double>(STEPS);
    points[k].time = point.time - (1.0 - s) * length;
    for (std::size_t i = 0; i < point.joints.size(); ++i)
    {
      const double speed = point.joints[i].velocity;
      const double bend = length * point.joints[i].acceleration;
      JointMotion& joint = points[k].joints[i];
      joint.velocity = s * s * (speed * (3.0 - 2.0 * s) + bend * (s - 1.0));
      joint.acceleration = s * (6.0 * speed * (1.0 - s) + bend * (3.0 * s - 2.0)) / length;
      joint.position -=
          length * (0.5 * speed - bend / 12.0 - s * s * s * (speed * (1.0 - 0.5 * s) + bend * (0.25 * s - 1.0 / 3.0)));
    }
  }
  return points;
}

std::vector<ArmSetPoint> toRest(const ArmSetPoint& point)
{
  // As from rest, backwards in time.
  const auto turned = [&](ArmSetPoint at)
  {
    at.time = 2.0 * point.time - at.time;
    for (JointMotion& joint : at.joints)
    {
      joint.velocity = -joint.velocity;
    }
    return at;
  };
  std::vector<ArmSetPoint> points = fromRest(turned(point));
  std::transform(points.begin(), points.end(), points.begin(), turned);
  std::reverse(points.begin(), points.end());
  return points;
}

ArmMotion gentleMotion(const ArmDescription& arm)
{
  constexpr double ACCELERATION = 2.0;                           // [rad/s^2]
  constexpr std::array SPEEDS{ 0.35, 0.7, 1.05 };                // of the joint that goes farthest [rad/s]
  constexpr std::array WAYS{ 0.6, 0.4, -0.6, 0.5, -0.55, 0.6 };  // from the pose in the middle, both ways [rad]
  constexpr double PERIOD = 0.008;                               // of the set points [s]
  const std::size_t joints = arm.joints.size();
  const bool is_known =
      std::all_of(arm.joints.begin(), arm.joints.end(),
                  [](const ArmJoint& joint) { return joint.speed_limit > 0.0 && joint.torque_limit > 0.0; });
  const std::vector<double>& middle = arm.joints[std::min<std::size_t>(1, joints - 1)].check_up;
  std::vector<ArmSetPoint> points;
  if (!is_known || middle.empty())
  {
    points.push_back({ 0.0, std::vector<JointMotion>(joints) });
    return ArmMotion(points);
  }
  std::vector<ArmMove> moves;
  for (const double speed : SPEEDS)
  {
    for (const double side : { 1.0, -1.0, 0.0 })
    {
      moves.push_back({ middle, speed, ACCELERATION });
      for (std::size_t i = 0; i < joints; ++i)
      {
        moves.back().target[i] += side * WAYS[i % WAYS.size()];
      }
    }
  }
  for (ArmInstant& instant : sampleMoves(arm, middle, moves, PERIOD))
  {
    points.push_back({ instant.time, std::move(instant.joints) });
  }
  return ArmMotion(std::move(points), ArmAccelerations::GIVEN, true);
}
}  // namespace hjt
