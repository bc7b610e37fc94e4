// SPDX-License-Identifier: BSD-3-Clause
// The payload that an arm's currents show while its rows come: taken up, put down, after a jump of the time.
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <gmock/gmock.h>

#include "arm/payload_watch.hpp"
#include "test/core/arm_support.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
const Payload CARRIED{ 3.0, { 0.0, 0.03, 0.08 } };
constexpr double LONG = 40.0;  // more than the motion after which a payload is looked for [s]
constexpr std::size_t ELBOW = 2;

/// An arm in motion, its currents those of its twins with what it carries, and the watch beside it.
struct WatchedArm
{
  void move(double begin, double seconds, const Payload& carried)
  {
    ArmDescription with = arm;
    with.payload = carried;
    ArmDynamics loaded(with);
    ArmDynamics expected(watch.arm());
    ArmSample sample;
    sample.joints.resize(arm.joints.size());
    std::vector<JointMotion> motion(arm.joints.size());
    constexpr double PERIOD = 0.025;  // [s]
    for (int row = 0; row * PERIOD < seconds; ++row)
    {
      const double time = begin + PERIOD * row;
      for (std::size_t i = 0; i < motion.size(); ++i)
      {
        const double rate = 0.9 + 0.13 * static_cast<double>(i);
        motion[i] = { BENT[i] + 0.8 * std::sin(rate * time), 0.8 * rate * std::cos(rate * time),
                      -0.8 * rate * rate * std::sin(rate * time) };
      }
      const std::vector<double> torques = torquesOf(loaded, motion);
      sample.torques = torquesOf(expected, motion);
      for (std::size_t i = 0; i < motion.size(); ++i)
      {
        MotionSample& joint = sample.joints[i];
        joint = MotionSample();
        joint.time = time;
        joint.position = motion[i].position;
        joint.velocity = motion[i].velocity;
        joint.acceleration = motion[i].acceleration;
        MotionSample own = joint;
        own.load = torques[i];
        own.after_gap = row == 0;
        joint.current = i == silent ? 0.0 : drives[i].step(own).current;
      }
      watch.add(sample);
    }
  }

  ArmDescription arm = shipped("ur5");
  std::vector<Parameters> parameters = std::vector<Parameters>(6, shippedParameters());
  std::vector<MotionDriven> drives = std::vector<MotionDriven>(6, MotionDriven(parameters.front()));
  PayloadWatch watch{ arm, parameters };
  std::size_t silent = 6;  // none
};

TEST(PayloadWatch, FindsWhatIsTakenUpAndThatItIsPutDown)
{
  WatchedArm robot;
  robot.move(0.0, LONG, CARRIED);
  const std::optional<IdentifiedPayload> found = robot.watch.look();
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->isCarried());
  EXPECT_NEAR(found->mass, CARRIED.mass, 0.5);
  robot.watch.configure(found->payload());

  robot.move(LONG, LONG, CARRIED);
  EXPECT_FALSE(robot.watch.look()) << "it counts already";

  robot.watch.configure(found->payload());
  robot.move(2.0 * LONG, LONG, {});
  const std::optional<IdentifiedPayload> left = robot.watch.look();
  ASSERT_TRUE(left);
  EXPECT_FALSE(left->isCarried());
  EXPECT_NEAR(left->mass, 0.0, 0.5);
  EXPECT_EQ(left->configured.mass, 0.0);
  robot.watch.configure(robot.watch.given());
  EXPECT_EQ(robot.watch.arm().payload.mass, 0.0);
}

TEST(PayloadWatch, StartsAgainAfterAJumpBackOfTheTime)
{
  WatchedArm robot;
  robot.move(7200.0, 5.0, CARRIED);
  robot.watch.reset();
  robot.move(0.0, LONG, CARRIED);
  const std::optional<IdentifiedPayload> found = robot.watch.look();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->mass, CARRIED.mass, 0.5);
}

TEST(PayloadWatch, LeavesOutAJointWithoutEfforts)
{
  WatchedArm robot;
  robot.silent = ELBOW;
  robot.watch.setMeasured(ELBOW, false);
  robot.move(0.0, LONG, {});
  EXPECT_FALSE(robot.watch.look());

  robot.watch.reset();
  robot.move(LONG, LONG, CARRIED);
  const std::optional<IdentifiedPayload> found = robot.watch.look();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->mass, CARRIED.mass, 0.5);
}
}  // namespace
}  // namespace hjt
