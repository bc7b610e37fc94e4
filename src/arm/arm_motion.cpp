// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_motion.hpp"

namespace hjt
{
void ArmMotion::at(double time, std::vector<JointMotion>& motion) noexcept
{
  if (time <= begin() || time >= end())
  {
    const ArmSetPoint& point = time <= begin() ? points_.front() : points_.back();
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      motion[i] = { point.joints[i].position, 0.0, 0.0 };
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
    motion[i].acceleration = a.acceleration + s * (b.acceleration - a.acceleration);
  }
}
}  // namespace hjt
