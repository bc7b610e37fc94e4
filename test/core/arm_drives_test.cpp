// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "arm/arm_configuration.hpp"
#include "arm/arm_motion.hpp"
#include "test_parameters.hpp"
#include "tracking/friction_map.hpp"

namespace hjt
{
namespace
{
/// Of every shipped arm: beyond a limit it throws.
TEST(GentleMotion, TakesEveryJointBothWaysSlowlyAndFast)
{
  for (const char* name : { "ur3", "ur3e", "ur5", "ur5e", "ur10", "ur10e", "ur15", "ur16e", "ur18", "ur8long" })
  {
    const ArmDescription arm = readArmDescription(findArm(name, HJT_TEST_CONFIG_DIR));
    const ArmMotion motion = gentleMotion(arm);
    for (std::size_t i = 0; i < arm.joints.size(); ++i)
    {
      double slowest = 0.0;
      double fastest = 0.0;
      for (const ArmSetPoint& point : motion.points())
      {
        slowest = std::min(slowest, point.joints[i].velocity);
        fastest = std::max(fastest, point.joints[i].velocity);
      }
      EXPECT_GT(fastest, 0.6) << name << ' ' << i;
      EXPECT_LT(slowest, -0.6) << name << ' ' << i;
      EXPECT_NEAR(motion.points().front().joints[i].position, motion.points().back().joints[i].position, 1e-12);
    }
  }
}

/// The scene is chosen for a joint whose files leave it as shipped, and for that alone.
TEST(ArmDriveMaps, AJointsOwnSceneCounts)
{
  ArmDescription arm = readArmDescription(findArm("ur5", HJT_TEST_CONFIG_DIR));
  arm.joints[2].parameters["solver.scene"] = { std::string("full_ring"), "the arm's file" };
  ConfigurationOptions options;
  options.config_dir = HJT_TEST_CONFIG_DIR;
  const auto scene_of = [&](std::size_t joint)
  { return parseParameters(armDriveMaps(arm, options, "")[joint]).solver.scene; };
  EXPECT_EQ(scene_of(2), SceneKind::FULL_RING);
  EXPECT_EQ(scene_of(1), SceneKind::AUTO);
  options.assignments = { "solver.scene=full_ring" };
  EXPECT_EQ(scene_of(1), SceneKind::FULL_RING);
}

/// A motor may hold more than its gear bears: those loads are left out.
TEST(FrictionMap, IsMadeForEveryDriveOfEveryShippedArm)
{
  std::set<std::vector<std::string>> seen;
  for (const char* name : { "ur3", "ur3e", "ur5", "ur5e", "ur10", "ur10e", "ur15", "ur16e", "ur18", "ur8long" })
  {
    for (const ArmJoint& joint : readArmDescription(findArm(name, HJT_TEST_CONFIG_DIR)).joints)
    {
      if (seen.insert(joint.overlays).second)
      {
        const Parameters parameters = parseParameters(armJointParameters(joint, HJT_TEST_CONFIG_DIR, ""));
        const FrictionMap map(parameters);
        const double bears = parameters.output.load_torque_limit;
        EXPECT_GT(map.at(10.0, 0.8 * bears, 25.0).sum(), map.at(10.0, 0.0, 25.0).sum()) << name << joint.short_name;
      }
    }
  }
}

TEST(GiveOwnSeeds, NoDriveIsAnotherAndPerfectOnesStayAlike)
{
  std::vector<Parameters> drives(6, shippedParameters());
  giveOwnSeeds(drives);
  EXPECT_EQ(drives[5].manufacture.circular_spline_pitch.seed, drives[0].manufacture.circular_spline_pitch.seed);
  for (Parameters& each : drives)
  {
    each.manufacture.flexspline_pitch.deviation = 4e-6;
    each.manufacture.circular_spline_pitch.deviation = 9.5e-6;
  }
  giveOwnSeeds(drives);
  std::set<int> seeds;
  for (const Parameters& each : drives)
  {
    seeds.insert({ each.manufacture.flexspline_pitch.seed, each.manufacture.circular_spline_pitch.seed });
  }
  EXPECT_EQ(seeds.size(), 12U);
}
}  // namespace
}  // namespace hjt
