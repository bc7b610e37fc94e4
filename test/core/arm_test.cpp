// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
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
#include "base/number_table.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "identification/payload_fit.hpp"
#include "statics/gear_checks.hpp"
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

TEST(ShippedArms, HaveDrivesThatGoTogether)
{
  EXPECT_EQ(shippedArms().size(), 7u);
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
      EXPECT_NEAR(parameters.motor.speed_limit / nominalRatio(parameters.gear), joint.speed_limit, 1e-3);
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
  arm.joints.emplace_back().name = "seventh_joint";
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

/// Two joints swing, with or without the velocity recorded beside.
std::vector<MotionRow> swinging(double time, double stamp, bool with_velocity)
{
  constexpr double RATE = 4.0;
  Angles angles = BENT;
  angles[1] += 0.4 * std::sin(RATE * time);
  angles[2] -= 0.3 * std::cos(RATE * time);
  std::vector<MotionRow> rows = rowsOf(stamp, angles);
  for (std::size_t i = 0; with_velocity && i < rows.size(); ++i)
  {
    rows[i].recorded_velocity =
        i == 1 ? 0.4 * RATE * std::cos(RATE * time) : (i == 2 ? 0.3 * RATE * std::sin(RATE * time) : 0.0);
  }
  return rows;
}

/// Largest error of the elbow's load where rows of 8 and 24 ms are stamped every 16 ms [N.m].
double errorOfUnevenRows(bool with_velocity)
{
  ArmLoad load(shipped("ur5"));
  ArmLoad exact(shipped("ur5"));
  std::vector<double> stamps;
  std::vector<double> expected;
  double worst = 0.0;
  const auto take = [&](ArmLoad& from, const std::function<void(const ArmSample&)>& visit)
  {
    while (const ArmSample* sample = from.pop())
    {
      visit(*sample);
    }
  };
  std::size_t compared = 0;
  for (int i = 0; i < 400; ++i)
  {
    const double time = 0.016 * i + (i % 2 == 1 ? -0.004 : 0.004);
    exact.push(swinging(time, time, false));
    load.push(swinging(time, 0.016 * i, with_velocity));
    take(exact, [&](const ArmSample& sample) { expected.push_back(sample.torques[2]); });
    take(load,
         [&](const ArmSample& sample)
         {
           EXPECT_NEAR(sample.joints[2].time, 0.016 * static_cast<double>(compared), 1e-9) << "stamps stay";
           stamps.push_back(sample.torques[2]);
           ++compared;
         });
  }
  for (std::size_t i = 20; i < std::min(stamps.size(), expected.size()); ++i)
  {
    worst = std::max(worst, std::abs(stamps[i] - expected[i]));
  }
  return worst;
}

TEST(ArmLoad, VelocitiesMendTheTimesOfUnevenRows)
{
  EXPECT_GT(errorOfUnevenRows(false), 0.5);
  EXPECT_LT(errorOfUnevenRows(true), 0.1);
}

TEST(ArmLoad, UnevenRowsWithoutVelocitiesMakeNoVibration)
{
  ArmLoad load(shipped("ur5"));
  double largest = 0.0;
  int samples = 0;
  for (int i = 0; i < 600; ++i)
  {
    load.push(swinging(0.016 * i + (i % 2 == 1 ? -0.004 : 0.004), 0.016 * i, false));
    while (const ArmSample* sample = load.pop())
    {
      largest = sample->joints[2].time > 1.0 ? std::max(largest, std::abs(sample->joints[2].vibration)) : 0.0;
      ++samples;
    }
  }
  EXPECT_GT(samples, 580);
  EXPECT_LT(largest, 3.0);
}

/// Torques of the elbow, with the velocities changed.
std::vector<double> torquesWith(const std::function<void(std::vector<MotionRow>&)>& change)
{
  ArmLoad load(shipped("ur5"));
  std::vector<double> torques;
  for (int i = 0; i < 300; ++i)
  {
    std::vector<MotionRow> rows = swinging(0.008 * i, 0.008 * i, true);
    change(rows);
    load.push(rows);
    while (const ArmSample* sample = load.pop())
    {
      torques.push_back(sample->torques[2]);
    }
  }
  return torques;
}

TEST(ArmLoad, VelocitiesOfAnotherUnitOrSignMendNothing)
{
  const std::vector<double> sound = torquesWith([](std::vector<MotionRow>&) {});
  const std::vector<double> degrees = torquesWith(
      [](std::vector<MotionRow>& rows)
      {
        for (MotionRow& row : rows)
        {
          row.recorded_velocity *= 180.0 / M_PI;
        }
      });
  EXPECT_EQ(sound, degrees);
  const std::vector<double> flipped =
      torquesWith([](std::vector<MotionRow>& rows) { rows[1].recorded_velocity *= -1.0; });
  ASSERT_EQ(sound.size(), flipped.size());
  for (std::size_t i = 60; i < sound.size(); ++i)  // until then the velocities may be right
  {
    EXPECT_NEAR(flipped[i], sound[i], 1e-6) << i;
  }
}

TEST(ArmLoad, VibrationIsWhatFasterRatesTakeBeyondTheLoad)
{
  constexpr double RATE = 2.0 * M_PI * 15.0;
  constexpr double SIZE = 2e-4;
  ArmDynamics dynamics(shipped("ur5"));
  ArmLoad load(shipped("ur5"));
  Angles upward = BENT;
  const std::vector<double> weight = torquesOf(dynamics, motionOf(upward));
  const std::vector<double> unit = torquesOf(dynamics, motionOf(upward, {}, { 0.0, 1.0 }));
  const double inertia = unit[1] - weight[1];
  double in_phase = 0.0;
  double reference = 0.0;
  double slow = 0.0;
  for (int i = 0; i < 500; ++i)
  {
    Angles angles = BENT;
    angles[1] += SIZE * std::sin(RATE * 0.008 * i);
    load.push(rowsOf(0.008 * i, angles));
    while (const ArmSample* sample = load.pop())
    {
      const double expected = -inertia * SIZE * RATE * RATE * std::sin(RATE * sample->joints[1].time);
      in_phase += sample->joints[1].vibration * expected;
      reference += expected * expected;
      slow = std::max(slow, std::abs(sample->torques[1] - weight[1]));
    }
  }
  EXPECT_NEAR(in_phase / reference, 0.42, 0.02) << "of it, by the parabola over 72 ms";
  EXPECT_LT(slow, 0.3 * inertia * SIZE * RATE * RATE);
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

/// Samples and currents of an arm with a payload, of which the twins know nothing, with friction and gains that they
/// know badly.
struct LoadedArm
{
  explicit LoadedArm(const Payload& payload) : samples(6), predicted(6)
  {
    ArmDescription with = arm;
    with.payload = payload;
    ArmDynamics bare(arm);
    ArmDynamics heavy(with);
    std::mt19937 engine(11);
    std::normal_distribution<double> unit;
    for (int row = 0; row < 5000; ++row)
    {
      const double time = 0.008 * row;
      std::vector<JointMotion> motion(6);
      for (std::size_t i = 0; i < 6; ++i)
      {
        const double rate = 0.9 + 0.13 * static_cast<double>(i);
        motion[i] = { BENT[i] + 0.8 * std::sin(rate * time), 0.8 * rate * std::cos(rate * time),
                      -0.8 * rate * rate * std::sin(rate * time) };
      }
      const std::vector<double> expected = torquesOf(bare, motion);
      const std::vector<double> torques = torquesOf(heavy, motion);
      for (std::size_t i = 0; i < 6; ++i)
      {
        MotionSample sample;
        sample.time = time;
        sample.position = motion[i].position;
        sample.velocity = motion[i].velocity;
        sample.acceleration = motion[i].acceleration;
        sample.load = expected[i];
        const double friction = 0.2 * std::copysign(1.0, sample.velocity) + 0.1 * sample.velocity;
        sample.current = 1.04 * torques[i] / gains[i] + friction + 0.3 * unit(engine);
        samples[i].push_back(sample);
        predicted[i].push_back(expected[i] / gains[i]);
      }
    }
  }

  ArmDescription arm = shipped("ur5");
  std::vector<double> gains = std::vector<double>(6, 10.7);
  std::vector<std::vector<MotionSample>> samples;
  std::vector<std::vector<double>> predicted;
};

TEST(IdentifyPayload, FindsMassAndCentreBesideWrongFrictionAndGain)
{
  const Payload payload{ 3.0, { 0.02, -0.03, 0.08 } };
  LoadedArm robot(payload);
  const IdentifiedPayload found = identifyPayload(robot.arm, robot.samples, robot.predicted, robot.gains);
  EXPECT_NEAR(found.mass, 3.0, found.mass_half_width);
  EXPECT_TRUE(found.differs());
  EXPECT_GT(found.mass_half_width, 0.0);
  EXPECT_LT(found.mass_half_width, 0.5);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    EXPECT_NEAR(found.moment[axis], 3.0 * payload.centre[axis], 0.05) << axis;
    EXPECT_DOUBLE_EQ(found.payload().centre[axis], found.moment[axis] / found.mass) << axis;
  }
  EXPECT_EQ(found.payload().mass, found.mass);

  // Once it is configured, nothing more is found.
  ArmDescription loaded = robot.arm;
  loaded.payload = payload;
  for (std::size_t i = 0; i < 6; ++i)
  {
    for (std::size_t row = 0; row < robot.samples[i].size(); ++row)
    {
      robot.predicted[i][row] = robot.samples[i][row].current;
    }
  }
  const IdentifiedPayload again = identifyPayload(loaded, robot.samples, robot.predicted, robot.gains);
  EXPECT_NEAR(again.mass, 3.0, 1e-9);
  EXPECT_FALSE(again.differs());
}

TEST(IdentifyPayload, ClaimsNoPayloadThatArmsWithoutOneShowToo)
{
  const LoadedArm robot({ 0.6, {} });
  const IdentifiedPayload found = identifyPayload(robot.arm, robot.samples, robot.predicted, robot.gains);
  EXPECT_NEAR(found.mass, 0.6, found.mass_half_width);
  EXPECT_LT(found.mass_half_width, 0.6) << "it is seen";
  EXPECT_GT(found.least_claim, 0.6);
  EXPECT_FALSE(found.differs());
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
