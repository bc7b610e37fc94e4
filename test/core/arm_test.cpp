// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl_parser/kdl_parser.hpp>

#include "arm/arm_dynamics.hpp"
#include "arm/arm_load.hpp"
#include "base/number_table.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
using Angles = std::array<double, 6>;

ArmDescription shipped(const std::string& name)
{
  return readArmDescription(HJT_TEST_CONFIG_DIR "/arms/" + name + ".yaml");
}

std::vector<JointMotion> motionOf(const Angles& position, const Angles& velocity = {}, const Angles& acceleration = {})
{
  std::vector<JointMotion> motion(position.size());
  for (std::size_t i = 0; i < motion.size(); ++i)
  {
    motion[i] = { position[i], velocity[i], acceleration[i] };
  }
  return motion;
}

std::vector<double> torquesOf(ArmDynamics& dynamics, const std::vector<JointMotion>& motion)
{
  std::vector<double> torques(motion.size());
  dynamics.torques(motion, torques);
  return torques;
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

constexpr Angles BENT{ 0.1, -1.2, 0.7, -0.5, 0.9, 0.4 };

TEST(ArmDynamics, WeightIsTheSlopeOfThePotentialEnergy)
{
  for (const std::string name : { "ur5", "ur5e" })
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
  for (const std::string name : { "ur5", "ur5e" })
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
  const auto text = [](const ArmDescription& arm)
  {
    try
    {
      const ArmDynamics dynamics(arm);
    }
    catch (const ParameterError& error)
    {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  ArmDescription arm = shipped("ur5");
  arm.joints[2].name = "knee_joint";
  EXPECT_THAT(text(arm), testing::HasSubstr("joint 2 of the URDF's chain is 'elbow_joint', not 'knee_joint'"));
  arm = shipped("ur5");
  arm.joints.push_back({ "seventh_joint", "", {}, {} });
  EXPECT_THAT(text(arm), testing::HasSubstr("has no joint 'seventh_joint'"));
  arm = shipped("ur5");
  arm.tip = "hand";
  EXPECT_THAT(text(arm), testing::HasSubstr("no chain of links from 'base_link' to 'hand'"));
  EXPECT_THROW(readArmDescription("no/such/arm.yaml"), ParameterError);
}

std::vector<MotionRow> rowsOf(double time, const Angles& angles)
{
  std::vector<MotionRow> rows(angles.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    rows[i].time = time;
    rows[i].position = angles[i];
  }
  return rows;
}

TEST(ArmLoad, FollowsASwingWithUnevenRowsAndAGap)
{
  const ArmDescription arm = shipped("ur5");
  ArmDynamics dynamics(arm);
  ArmLoad load(arm);
  constexpr double RATE = 2.0;
  const auto swing = [](double time)
  {
    Angles angles = BENT;
    angles[1] += 0.5 * std::sin(RATE * time);
    angles[2] -= 0.5 * std::sin(RATE * time);
    return angles;
  };
  double worst = 0.0;
  int samples = 0;
  int gaps = 0;
  const auto take = [&](bool at_end)
  {
    while (const ArmSample* ready = load.pop(at_end))
    {
      const double time = ready->joints.front().time;
      const double speed = 0.5 * RATE * std::cos(RATE * time);
      const double acceleration = -0.5 * RATE * RATE * std::sin(RATE * time);
      const std::vector<double> expected =
          torquesOf(dynamics, motionOf(swing(time), { 0.0, speed, -speed }, { 0.0, acceleration, -acceleration }));
      const bool is_inside = (time > 0.11 && time < 1.9) || (time > 2.31 && time < 3.85);
      worst = is_inside ? std::max(worst, std::abs(ready->torques[1] - expected[1])) : worst;
      gaps += ready->joints.front().after_gap ? 1 : 0;
      ++samples;
    }
  };
  int pushed = 0;
  for (int i = 0; i < 500; ++i)
  {
    const double time = 0.008 * i + (i % 3 == 0 ? 0.002 : 0.0);
    if (time > 2.0 && time < 2.2)
    {
      continue;
    }
    pushed += load.push(rowsOf(time, swing(time))) ? 1 : 0;
    take(false);
  }
  EXPECT_FALSE(load.push(rowsOf(3.9, swing(3.9)))) << "earlier than the row before";
  EXPECT_FALSE(load.push(rowsOf(5.0, { std::nan("") })));
  take(true);
  EXPECT_EQ(samples, pushed);
  EXPECT_EQ(gaps, 1);
  EXPECT_LT(worst, 0.05);
}

TEST(ArmLoad, AllocatesNothingAfterConstruction)
{
  ArmLoad load(shipped("ur5"));
  const std::vector<MotionRow> rows = rowsOf(0.0, BENT);
  std::vector<MotionRow> row = rows;
  const std::size_t before = allocationCount();
  for (int i = 0; i < 1000; ++i)
  {
    for (MotionRow& joint : row)
    {
      joint.time = 0.002 * i;
    }
    load.push(row);
    while (load.pop() != nullptr)
    {
    }
  }
  EXPECT_EQ(allocationCount(), before);
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
