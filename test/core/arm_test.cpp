// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl_parser/kdl_parser.hpp>

#include "arm/arm_configuration.hpp"
#include "arm/arm_dynamics.hpp"
#include "arm/arm_load.hpp"
#include "arm/moving_arm.hpp"
#include "base/csv_table.hpp"
#include "elements/motor.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "statics/gear_rules.hpp"
#include "test/core/arm_support.hpp"
#include "test/core/complaint.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
std::vector<std::string> shippedArms()
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(HJT_TEST_CONFIG_DIR "/arms"))
  {
    if (entry.path().extension() == ".yaml")
    {
      names.push_back(entry.path().stem().string());
    }
  }
  return names;
}

/// Potential energy of links and payload from the heights of their centres of mass [J].
double potentialEnergy(const ArmDescription& arm, const Angles& angles)
{
  KDL::Tree tree;
  KDL::Chain chain;
  kdl_parser::treeFromString(arm.urdf, tree);
  tree.getChain(arm.base, arm.tip, chain);
  KDL::ChainFkSolverPos_recursive kinematics(chain);
  KDL::JntArray position(chain.getNrOfJoints());
  for (unsigned i = 0; i < angles.size(); ++i)
  {
    position(i) = angles[i];
  }
  const KDL::Vector gravity(arm.gravity[0], arm.gravity[1], arm.gravity[2]);
  double energy = 0.0;
  KDL::Frame frame;
  for (unsigned i = 0; i < chain.getNrOfSegments(); ++i)
  {
    kinematics.JntToCart(position, frame, static_cast<int>(i) + 1);
    const KDL::RigidBodyInertia& body = chain.getSegment(i).getInertia();
    energy -= body.getMass() * KDL::dot(gravity, frame * body.getCOG());
  }
  const std::array<double, 3>& centre = arm.payload.centre;
  return energy - arm.payload.mass * KDL::dot(gravity, frame * KDL::Vector(centre[0], centre[1], centre[2]));
}

TEST(ShippedArms, HaveDrivesThatGoTogether)
{
  EXPECT_EQ(shippedArms().size(), 12u);
  std::set<std::vector<std::string>> seen;
  for (const std::string& name : shippedArms())
  {
    for (const ArmJoint& joint : shipped(name).joints)
    {
      const Parameters parameters = parseParameters(armJointParameters(joint, HJT_TEST_CONFIG_DIR, ""));
      // The joint's greatest torque stays below what the gear bears, and its motor makes it through the losses.
      EXPECT_LE(joint.torque_limit, parameters.life.repeated_peak_torque) << name << ", " << joint.name;
      EXPECT_LE(joint.torque_limit, parameters.output.torque_limit) << name << ", " << joint.name;
      EXPECT_GT(parameters.motor.torque_limit * nominalRatio(parameters.gear), joint.torque_limit / 0.7);
      // What stops the joint for its speed is the arm's controller, not the motor.
      EXPECT_NEAR(Motor(parameters.motor).fadeSpeed() / nominalRatio(parameters.gear),
                  MovingArm::STOP_SPEED * joint.speed_limit, 1e-3 * joint.speed_limit);
      if (seen.insert(joint.overlays).second)
      {
        EXPECT_THAT(gearWarnings(parameters), testing::IsEmpty()) << name << ", " << joint.name;
      }
    }
  }
}

TEST(ShippedArms, TakeTheKeysThatTheyDoNotGiveFromAnother)
{
  const ArmDescription own = shipped("ur10e");
  const ArmDescription other = shipped("ur10");
  EXPECT_NE(own.urdf, other.urdf);
  ASSERT_EQ(own.joints.size(), other.joints.size());
  EXPECT_EQ(own.joints[0].overlays, other.joints[0].overlays);
  EXPECT_EQ(own.joints[5].torque_limit, other.joints[5].torque_limit);
}

TEST(ArmDynamics, WeightIsTheSlopeOfThePotentialEnergy)
{
  for (const std::string& name : shippedArms())
  {
    ArmDescription arm = shipped(name);
    arm.payload = { 2.0, { 0.03, -0.02, 0.05 } };
    arm.gravity = { 1.0, -3.0, -9.0 };  // on a slope
    ArmDynamics dynamics(arm);
    const std::vector<double> torques = torquesOf(dynamics, motionOf(BENT));
    for (std::size_t i = 0; i < BENT.size(); ++i)
    {
      constexpr double STEP = 1e-5;
      Angles above = BENT;
      Angles below = BENT;
      above[i] += STEP;
      below[i] -= STEP;
      const double slope = (potentialEnergy(arm, above) - potentialEnergy(arm, below)) / (2.0 * STEP);
      EXPECT_NEAR(torques[i], slope, 1e-7) << name << ", joint " << i;
    }
  }
}

TEST(ArmDynamics, StretchedArmWeighsWhatItsMassesDo)
{
  const ArmDescription arm = shipped("ur5");
  ArmDynamics dynamics(arm);
  const std::vector<double> level = torquesOf(dynamics, motionOf({}));
  constexpr double WRISTS = 2.0 * 1.219 + 0.1879;
  const double elbow = 9.82 * (2.275 * 0.27232 + WRISTS * 0.39225);
  EXPECT_NEAR(std::abs(level[0]), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(level[1]), elbow + 9.82 * (8.393 * 0.2125 + (2.275 + WRISTS) * 0.425), 0.05);
  EXPECT_NEAR(std::abs(level[2]), elbow, 0.05);
}

/// From the Newton-Euler recursion in Denavit-Hartenberg frames, which a controller's own torques agree with.
TEST(ArmDynamics, MotionOfAllJointsCouples)
{
  ArmDynamics dynamics(shipped("ur5"));
  const std::vector<double> torques =
      torquesOf(dynamics, motionOf(BENT, { 0.3, -0.5, 0.7, -0.2, 0.4, 0.6 }, { 1.0, -2.0, 1.5, 0.5, -1.0, 2.0 }));
  const std::array<double, 6> expected{ 1.896405, -34.223342, -16.950993, -1.37869, 0.155667, 0.000359 };
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    EXPECT_NEAR(torques[i], expected[i], 2e-5) << "joint " << i;
  }
}

TEST(ArmDynamics, WorkOfASwingThatReturnsIsZero)
{
  for (const std::string& name : shippedArms())
  {
    ArmDynamics dynamics(shipped(name));
    constexpr int STEPS = 2000;
    double work = 0.0;
    double turnover = 0.0;
    for (int step = 0; step < STEPS; ++step)
    {
      Angles position = BENT;
      Angles velocity{};
      Angles acceleration{};
      for (std::size_t i = 0; i < BENT.size(); ++i)
      {
        const double rate = 2.0 * M_PI * static_cast<double>(1 + i % 3);  // of a swing of 1 s
        const double phase = rate * step / STEPS + static_cast<double>(i);
        position[i] += 0.4 * std::sin(phase);
        velocity[i] = 0.4 * rate * std::cos(phase);
        acceleration[i] = -0.4 * rate * rate * std::sin(phase);
      }
      const std::vector<double> torques = torquesOf(dynamics, motionOf(position, velocity, acceleration));
      const double power = std::inner_product(torques.begin(), torques.end(), velocity.begin(), 0.0);
      work += power / STEPS;
      turnover += std::abs(power) / STEPS;
    }
    EXPECT_GT(turnover, 10.0) << name;
    EXPECT_NEAR(work / turnover, 0.0, 1e-9) << name;
  }
}

TEST(ArmDynamics, SaysWhatTheDescriptionLacks)
{
  const auto text = [](ArmDescription arm) { return complaintOf([&] { readLinks(arm); }); };
  ArmDescription arm = shipped("ur5");
  arm.joints[2].name = "knee_joint";
  EXPECT_THAT(text(arm), testing::HasSubstr("joint 2 of the URDF's chain is 'elbow_joint', not 'knee_joint'"));
  arm = shipped("ur5");
  arm.joints.emplace_back().name = "seventh_joint";
  EXPECT_THAT(text(arm), testing::HasSubstr("has no joint 'seventh_joint'"));
  arm = shipped("ur5");
  arm.tip = "hand";
  EXPECT_THAT(text(arm), testing::HasSubstr("no chain of links from 'base' to 'hand'"));
  EXPECT_THROW(readArmDescription("no/such/arm.yaml"), ParameterError);
}

/// The controller's rigid-body torque in recordings of a UR5, from its own target motion. It takes the links for points
/// and adds the motors' inertia, both of which the test does too.
TEST(ArmDynamics, AgreesWithAController)
{
  const char* const set = std::getenv("HJT_TELEMETRY_DIR");
  const std::filesystem::path directory =
      set != nullptr ? std::filesystem::path(set) :
                       std::filesystem::path(HJT_TEST_CONFIG_DIR).parent_path() / "../shared/telemetry";
  const std::filesystem::path recording = directory / "ur5_cb/ur5_cb_no6.csv";
  if (!std::filesystem::exists(recording))
  {
    GTEST_SKIP() << "no recordings of a UR5 in " << directory << " (set HJT_TELEMETRY_DIR)";
  }
  NumberTable<24>::Names names;
  for (std::size_t i = 0; i < 6; ++i)
  {
    std::size_t column = i;
    for (const char* quantity : { "target_q_", "target_qd_", "target_qdd_", "target_moment_" })
    {
      names[column] = quantity + std::to_string(i);
      column += 6;
    }
  }
  NumberTable<24> table(recording.string(), names);
  std::array<double, 24> row{};
  const ArmDescription arm = shipped("ur5");
  ArmDynamics dynamics(arm);
  constexpr double RATIO = 101.0;
  constexpr std::array<double, 6> MOTOR{ 1.877e-4, 1.877e-4, 1.877e-4, 1.57e-5, 1.57e-5, 1.57e-5 };
  std::array<double, 6> squares{};
  double rows = 0.0;
  while (table.read(row))
  {
    std::vector<JointMotion> motion(6);
    for (std::size_t i = 0; i < 6; ++i)
    {
      motion[i] = { row[i], row[6 + i], row[12 + i] };
    }
    const std::vector<double> torques = torquesOf(dynamics, motion);
    for (std::size_t i = 0; i < 6; ++i)
    {
      const double error = torques[i] + MOTOR[i] * RATIO * RATIO * row[12 + i] - row[18 + i];
      squares[i] += error * error;
    }
    rows += 1.0;
  }
  for (std::size_t i = 0; i < 6; ++i)
  {
    const double rms = std::sqrt(squares[i] / rows);
    std::cout << arm.joints[i].short_name << ": " << rms << " N.m rms\n";
    EXPECT_LT(rms, i < 3 ? 0.1 : 0.01) << arm.joints[i].short_name;
  }
}
}  // namespace
}  // namespace hjt
