// SPDX-License-Identifier: BSD-3-Clause
#include "arm/moving_arm.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <gmock/gmock.h>

#include "test/core/rods.hpp"

namespace hjt
{
namespace
{
/// Its points given one by one are the motion; a copy in between goes on as the arm does.
TEST(MovingArm, APointAtATimeIsTheMotionAndACopyGoesOnAlike)
{
  std::vector<ArmSetPoint> points;
  for (int k = 0; k <= 25; ++k)
  {
    const double time = k / 125.0;
    const JointMotion joint{ 0.3 + 0.05 * std::sin(20.0 * time), std::cos(20.0 * time), -20.0 * std::sin(20.0 * time) };
    points.push_back({ time, { joint, { -0.8, 0.0, 0.0 } } });
  }
  const ArmDescription description = rods("0 1 0", 2);
  MovingArm whole(description, { drive(), drive() }, ArmMotion(points), {});
  MovingArm piecewise(description, { drive(), drive() }, ArmMotion({ points[0], points[0] }), {});
  const auto run_to = [](MovingArm& arm, double time)
  {
    while (arm.step(arm.motionBegin() + toStampLength(time)))
    {
    }
  };
  const auto expect_same = [](const MovingArm& one, const MovingArm& other)
  {
    ASSERT_EQ(one.twin().stamp(), other.twin().stamp());
    for (std::size_t i = 0; i < 2; ++i)
    {
      EXPECT_EQ(one.twin().motion()[i].position, other.twin().motion()[i].position);
      EXPECT_EQ(one.reading(i).current, other.reading(i).current);
    }
  };
  run_to(piecewise, 0.0);
  std::optional<MovingArm> copy;
  for (std::size_t k = 1; k < 25; ++k)
  {
    for (MovingArm* arm : { &piecewise, copy ? &*copy : nullptr })
    {
      if (arm != nullptr)
      {
        arm->goOn(points[k].time, points[k].joints);
        run_to(*arm, points[k].time);
      }
    }
    if (k == 10)
    {
      copy.emplace(piecewise);
    }
  }
  run_to(whole, points[24].time);
  expect_same(piecewise, whole);
  expect_same(*copy, whole);
  // A payload shows, and to the copy alone.
  copy->setPayload({ 3.0, { 0.1, 0.0, 0.0 } });
  run_to(*copy, points[24].time + 0.01);
  run_to(whole, points[24].time + 0.01);
  EXPECT_GT(std::abs(copy->reading(0).current - whole.reading(0).current), 0.1);
}
}  // namespace
}  // namespace hjt
