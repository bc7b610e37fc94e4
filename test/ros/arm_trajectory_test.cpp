// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/arm_trajectory.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace hjt
{
namespace
{
/// Three joints, of which the last moves.
const std::vector<JointMotion> PRESENT{ { 0.1, 0.0, 0.0 }, { 0.2, 0.0, 0.0 }, { 0.3, 0.6, 0.0 } };

ArmDescription arm()
{
  ArmDescription description;
  for (const char* name : { "a", "b", "c" })
  {
    description.joints.emplace_back();
    description.joints.back().name = name;
    description.joints.back().speed_limit = 3.0;
  }
  return description;
}

/// Angles at 1 s, 2 s ... without velocities.
trajectory_msgs::JointTrajectory trajectory(const std::vector<std::string>& names,
                                            const std::vector<std::vector<double>>& angles)
{
  trajectory_msgs::JointTrajectory message;
  message.joint_names = names;
  for (const std::vector<double>& positions : angles)
  {
    message.points.emplace_back();
    message.points.back().positions = positions;
    message.points.back().time_from_start = ros::Duration(static_cast<double>(message.points.size()));
  }
  return message;
}

/// The joints that it does not name come to rest, evenly, until its first point, and stay.
TEST(ArmTrajectory, APartialGoalMovesItsJointsAlone)
{
  std::vector<ArmSetPoint> points;
  ASSERT_EQ(readTrajectory(trajectory({ "b" }, { { 0.5 }, { 0.9 } }), arm(), PRESENT, 0.0, points), "");
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[1].joints[1].position, 0.5);
  EXPECT_NEAR(points[1].joints[1].velocity, 0.35, 1e-12);  // through both neighbours
  EXPECT_EQ(points[2].joints[1].position, 0.9);
  for (std::size_t k = 1; k < points.size(); ++k)
  {
    EXPECT_EQ(points[k].joints[0].position, 0.1);
    EXPECT_EQ(points[k].joints[2].position, 0.3 + 0.6 / 3.0);
    EXPECT_EQ(points[k].joints[2].velocity, 0.0);
  }
  ArmMotion motion(points, ArmAccelerations::OF_CUBICS);
  std::vector<JointMotion> at(3);
  for (const double time : { 0.25, 0.5, 0.75, 0.99 })
  {
    motion.at(time, at);
    EXPECT_NEAR(at[2].velocity, 0.6 * (1.0 - time) * (1.0 - time), 1e-12) << time;
  }
}

TEST(ArmTrajectory, OneWithoutPointsStops)
{
  const std::vector<ArmSetPoint> points = stopFrom(PRESENT);
  ArmMotion motion(points, ArmAccelerations::OF_CUBICS);
  std::vector<JointMotion> at(3);
  motion.at(0.0, at);
  EXPECT_EQ(at[2].velocity, 0.6);
  motion.at(1e-9, at);
  EXPECT_NEAR(at[2].acceleration, -4.0, 1e-6);
  motion.at(motion.end(), at);
  EXPECT_NEAR(motion.end(), 0.3, 1e-12);
  EXPECT_EQ(at[2].velocity, 0.0);
  EXPECT_EQ(at[0].position, 0.1);
}

TEST(ArmTrajectory, WhatItCannotFollowIsNamed)
{
  const auto errors = [](const trajectory_msgs::JointTrajectory& message)
  {
    std::vector<ArmSetPoint> points;
    return readTrajectory(message, arm(), PRESENT, 0.0, points);
  };
  EXPECT_EQ(errors(trajectory({ "b", "knee" }, { { 0.5, 0.5 } })),
            "the arm has no joint knee; the message names b, knee");
  EXPECT_EQ(errors(trajectory({ "b", "b" }, { { 0.5, 0.5 } })),
            "the message names more than once b; the message names b, b");
  EXPECT_EQ(errors(trajectory({}, { { 0.5 } })), "the message names no joint");
  EXPECT_THAT(errors(trajectory({ "b" }, { { 9.0 } })),
              testing::HasSubstr("b would reach 13.2 rad/s between the set point at 1 s"));
}
}  // namespace
}  // namespace hjt
