// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <iostream>
#include <numeric>
#include <set>

#include "arm/arm_description.hpp"
#include "arm/moving_arm.hpp"
#include "arm/set_points.hpp"
#include "elements/motor.hpp"
#include "test/core/arm_support.hpp"
#include "test/core/complaint.hpp"
#include "test/support/temporary_folder.hpp"

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

/// From the Newton-Euler recursion in Denavit-Hartenberg frames, which a controller's own torques agree with.
TEST(ArmDynamics, MotionOfAllJointsCouples)
{
  ArmDynamics dynamics(shipped("ur5"));
  const std::vector<double> torques =
      torquesOf(dynamics, motionOf(BENT, { 0.3, -0.5, 0.7, -0.2, 0.4, 0.6 }, { 1.0, -2.0, 1.5, 0.5, -1.0, 2.0 }));
  const std::array<double, 6> expected{ 1.896405, -34.223342, -16.950993, -1.37869, 0.155667, 0.000359 };
  EXPECT_THAT(torques, testing::Pointwise(testing::DoubleNear(2e-5), expected));
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

constexpr const char* SHIPPED = HJT_TEST_CONFIG_DIR "/arms/ur5.yaml";

/// `text` with its first `from` replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// One change of a sound file, and what is said about it.
struct Case
{
  const char* from;
  const char* to;
  const char* expected;
};

constexpr Case BAD_VALUES[] = {
  { "torque: 150.0", "torque: .nan",
    "arm.yaml:31: joints.0.limits.torque = .nan [N.m] is not a finite number, allowed: 0.001 ... 1.0e+6 [N.m]" },
  { "feedback: 42.8", "feedback: 0.0", "joints.0.limits.feedback = 0.0 [N.m] is out of range, allowed: 0.001" },
  { "torque: 150.0", "torque: -150.0", "joints.0.limits.torque = -150.0 [N.m] is out of range" },
  { "speed: 3.141592653589793", "speed: 0",
    "arm.yaml:31: joints.0.limits.speed = 0 [rad/s] is out of range, allowed: 0.001 ... 100 [rad/s]" },
  { "{speed: 3.141592653589793, torque: 150.0, feedback: 42.8}", "3", "joints.0.limits = 3 must be keys and values" },
  { "mass: 0.0", "mass: .nan", "arm.yaml:15: payload.mass = .nan [kg] is not a finite number, allowed: 0 ... 10000" },
  { "mass: 0.0", "mass: -3", "payload.mass = -3 [kg] is out of range, allowed: 0 ... 10000 [kg]" },
  { "mass: 0.0", "mass: 1.0e+300", "payload.mass = 1.0e+300 [kg] is out of range" },
  { "  mass: 0.0", "  mas: 0.0", "arm.yaml:15: unknown parameter payload.mas = 0.0 (did you mean payload.mass?)" },
  { "  mass: 0.0\n", "", "arm.yaml: parameter payload.mass is missing; expected a number [kg], 0 ... 10000" },
  { "centre: [0.0, 0.0, 0.0]", "centre: [0.0, 1e3, 0.0]", "payload.centre = [0.0, 1000.0, 0.0] [m] is out of range" },
  { "[0.0, 0.0, -9.82]", "[0.0, 0.0, .nan]", "arm.yaml:11: gravity = [0.0, 0.0, .nan] [m/s^2] is not a finite" },
  { "[0.0, 0.0, -9.82]", "[0.0, -9.82]", "gravity = [0.0, -9.82] must be a list of 3 numbers [m/s^2]" },
  { "[0.0, 0.0, -9.82]", "[0.0, down, -9.82]", "arm.yaml:11: gravity must be a list of numbers alone" },
  { "check_up: [0.0, -0.35,", "check_up: [.nan, -0.35,", "arm.yaml:33: joints.0.check_up = [.nan, -0.35, 0.0," },
  { "check_up: [0.0, -0.35,", "check_up: [100.0, -0.35,", "allowed: -6.283185307179586 ... 6.283185307179586 [rad]" },
  { "check_up: [0.0, -0.35,", "check_up: [-0.35,", "must be a list of 6 numbers [rad]" },
  { "short_name: base", "short_name: 'a b'",
    "arm.yaml:28: joints.0.short_name = 'a b' must be a name of letters, digits and underscores that begins with a "
    "letter" },
  { "short_name: base", "short_name: ../../../escaped", "joints.0.short_name = '../../../escaped' must be a name" },
  { "short_name: shoulder", "short_name: base",
    "arm.yaml:35: joints.1.short_name = 'base' must be another than joints.0.short_name" },
  { "short_name: base", "short_name: 5", "joints.0.short_name = 5 must be a text" },
  { "parameters: {telemetry.inertia_in_load: 1.877e-4}", "parameters: [1, 2]",
    "arm.yaml:30: joints.0.parameters = [1.0, 2.0] must be keys and values" },
  { "overlays: [joints/base.yaml, recorded_load.yaml, beside_robot.yaml]", "overlays: joints/base.yaml",
    "arm.yaml:29: joints.0.overlays = 'joints/base.yaml' must be a list of configuration files" },
  { "payload:\n", "payload:\n  mass: 1.0\n", "payload.mass occurs twice in this file (first at" },
  { "ur5.urdf", "/dev/zero",
    "arm.yaml:5: description: /dev/zero cannot be read: it is a directory, a device or a pipe" },
};

TEST(ArmDescription, WhatIsWrongIsNamedWithLineKeyValueUnitAndRange)
{
  const TemporaryFolder folder;
  const std::string text = textOf(SHIPPED);
  folder.write("ur5.urdf", readArmDescription(SHIPPED).urdf);
  const auto complaint = [&](const Case& one)
  {
    const std::string path = folder.write("arm.yaml", replaced(text, one.from, one.to));
    return complaintOf([&] { readArmDescription(path); });
  };
  for (const Case& one : BAD_VALUES)
  {
    EXPECT_THAT(complaint(one), testing::HasSubstr(one.expected)) << one.to;
  }
  EXPECT_EQ(complaint({ "mass: 0.0", "mass: 1e1", "" }), "");
  folder.write("ur5.urdf", std::string(10'000'001, ' '));
  EXPECT_THAT(complaint(BAD_VALUES[0]), testing::HasSubstr("joints.0.limits.torque"));
  EXPECT_THAT(complaint({ "mass: 0.0", "mass: 1.0", "" }),
              testing::HasSubstr("ur5.urdf cannot be read: it is larger than 10000000 bytes"));
}

TEST(ArmDescription, ParametersOfAJointAreNamedWithTheirLine)
{
  const TemporaryFolder folder;
  const std::string text = textOf(SHIPPED);
  folder.write("ur5.urdf", readArmDescription(SHIPPED).urdf);
  const std::string path =
      folder.write("arm.yaml", replaced(text, "telemetry.inertia_in_load: 1.877e-4", "motor.torqe_limit: 1.0"));
  const ArmDescription arm = readArmDescription(path);
  EXPECT_THAT(complaintOf([&] { parseParameters(armJointParameters(arm.joints[0], HJT_TEST_CONFIG_DIR, "")); }),
              testing::HasSubstr("arm.yaml:30: unknown parameter motor.torqe_limit = 1.0 (did you mean"));
}

TEST(ArmDrives, KeepTheRotorThatARecordingDoesNotShow)
{
  const ArmDescription arm = readArmDescription(SHIPPED);
  const TemporaryFolder folder;
  const auto rotor_of = [&](const char* identified)
  {
    folder.write("wrist_3.yaml", std::string("motor: {rotor_inertia: ") + identified + "}\n");
    return parseParameters(armDriveParameters(arm.joints[5], HJT_TEST_CONFIG_DIR, folder.path())).motor.rotor_inertia;
  };
  const double configured =
      parseParameters(armJointParameters(arm.joints[5], HJT_TEST_CONFIG_DIR, "")).motor.rotor_inertia;
  EXPECT_EQ(rotor_of("1.0e-9"), configured);
  EXPECT_EQ(rotor_of("1.0e-3"), 1e-3) << "more than configured is taken";
}

TEST(ArmDynamics, RefusesLinksThatNoRobotHas)
{
  const ArmDescription sound = readArmDescription(SHIPPED);
  for (const Case& one : {
           Case{ "<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>",
                 "joint 'shoulder_pan_joint' with link 'shoulder_link': its axis has no direction" },
           Case{ "<mass value=\"8.393\"/>", "<mass value=\"-3\"/>",
                 "joint 'shoulder_lift_joint' with link 'upper_arm_link': mass = -3.0 [kg] is out of range, allowed: 0 "
                 "..." },
           Case{ "<mass value=\"8.393\"/>", "<mass value=\"1e300\"/>", "mass = 1.0e+300 [kg] is out of range" },
           Case{ "ixx=\"", "ixx=\"-", "inertia = -" },
           Case{ "<mass value=\"8.393\"/>", "<mass value=\"8,393\"/>", "URDF cannot be read: " },
           Case{ "<mass value=\"8.393\"/>", "<mass value=\"8.393 kg\"/>", "URDF cannot be read: " },
           Case{ "<mass value=\"8.393\"/>", "<mass valu=\"8.393\"/>", "URDF cannot be read: " },
           Case{ "<mass value=\"8.393\"/>", "<mass value=\"nan\"/>", "URDF cannot be read: " },
           Case{ "<mass value=\"8.393\"/>", "<mass value=\"0\"/>",
                 "link 'upper_arm_link', which joint 'shoulder_lift_joint' moves, has no mass" },
       })
  {
    ArmDescription arm = sound;
    arm.urdf = replaced(arm.urdf, one.from, one.to);
    EXPECT_THAT(complaintOf([&] { readLinks(arm); }), testing::HasSubstr(one.expected)) << one.to;
  }
  ArmDescription massless = sound;
  for (std::size_t at = massless.urdf.find("<inertial>"); at != std::string::npos;
       at = massless.urdf.find("<inertial>"))
  {
    massless.urdf.erase(at, massless.urdf.find("</inertial>") + std::string("</inertial>").size() - at);
  }
  EXPECT_THAT(complaintOf([&] { readLinks(massless); }), testing::HasSubstr("link 'shoulder_link', which joint"));
  ArmDescription deep = sound;
  std::string flat;  // a hundred of them, none within another
  for (int i = 0; i < 100; ++i)
  {
    flat += "<!-- don't <a><b> --><b text='1 > 0'/>";
  }
  std::string nest;
  for (int i = 0; i < 100; ++i)
  {
    nest = "<a>" + nest + "</a>";
  }
  deep.urdf = replaced(sound.urdf, "</robot>", flat + nest + "</robot>");
  EXPECT_THAT(complaintOf([&] { readLinks(deep); }), testing::HasSubstr("more than 100 levels of nested elements"));
  deep.urdf = replaced(sound.urdf, "</robot>", flat + nest.substr(3, nest.size() - 7) + "<b/></robot>");
  EXPECT_EQ(complaintOf([&] { readLinks(deep); }), "");
}

TEST(SetPoints, NoArmIsToldWhatItCannotDo)
{
  const ArmDescription arm = readArmDescription(SHIPPED);
  const auto errors = [&](double angle, double end)
  {
    std::vector<ArmSetPoint> points{ { 0.0, std::vector<JointMotion>(6) }, { end, std::vector<JointMotion>(6) } };
    points[1].joints[2].position = angle;
    return motionErrors(points, arm);
  };
  EXPECT_EQ(errors(2.9, 1.0), "");
  EXPECT_EQ(errors(6.3, 10.0), "");
  EXPECT_THAT(errors(6.4, 10.0),
              testing::HasSubstr("elbow_joint: angle = 6.4 [rad] is out of range, allowed: -6.3355 ... 6.3355"));
  EXPECT_THAT(errors(1e300, 1.0), testing::HasSubstr("elbow_joint: angle = 1.0e+300 [rad] is out of range"));
  EXPECT_THAT(errors(std::nan(""), 1.0), testing::HasSubstr("out of range"));
  EXPECT_THAT(errors(2.9, 0.2), testing::HasSubstr("elbow_joint would turn at 14.5 rad/s at 0.2 s, its limit is 3.14"));
  EXPECT_THAT(errors(2.9, 6e8), testing::HasSubstr("set point 2: it is 6.0e+8 s after the first"));
  EXPECT_THAT(errors(0.0, 0.0), testing::HasSubstr("set point 2: the time does not increase"));
}

/// Set points of the elbow at the angles x(t), 8 ms apart; the other joints stand.
template <class Angle>
std::vector<ArmSetPoint> elbowAlong(int rows, const Angle& x)
{
  std::vector<ArmSetPoint> points;
  for (int k = 0; k < rows; ++k)
  {
    points.push_back({ 0.008 * k, std::vector<JointMotion>(6) });
    points.back().joints[2].position = x(points.back().time);
  }
  return points;
}

TEST(SetPoints, MissingRatesAreDifferencesAndAJointRestsAtTheEndsIfItCan)
{
  const auto slow = [](double t) { return 0.3 + 0.04 * t + 4.0 * t * t; };
  std::vector<ArmSetPoint> points = elbowAlong(5, slow);
  fillRates(points, false, false);
  for (std::size_t k : { 1U, 2U, 3U })
  {
    EXPECT_NEAR(points[k].joints[2].velocity, 0.04 + 8.0 * points[k].time, 1e-12) << k;
  }
  EXPECT_EQ(points[0].joints[2].velocity, 0.0);  // 0.072 rad/s after 8 ms is 9 rad/s^2
  EXPECT_NEAR(points[4].joints[2].velocity, 0.04 + 8.0 * 0.028, 1e-12);
  EXPECT_NEAR(points[2].joints[2].acceleration, 8.0, 1e-9);
  EXPECT_NEAR(points[0].joints[2].acceleration, (0.04 + 8.0 * 0.008) / 0.008, 1e-9);
  EXPECT_EQ(points[2].joints[1].velocity, 0.0);

  points = elbowAlong(5, slow);
  points[2].joints[2].velocity = 7.0;
  fillRates(points, true, false);
  EXPECT_EQ(points[2].joints[2].velocity, 7.0);
  EXPECT_NEAR(points[1].joints[2].acceleration, 7.0 / 0.016, 1e-9);
}

TEST(SetPoints, JitterOfTheStampsIsFoundByTheSpeeds)
{
  const auto x = [](double t) { return 0.5 * t; };
  std::vector<ArmSetPoint> even = elbowAlong(50, x);
  for (ArmSetPoint& point : even)
  {
    point.joints[2].velocity = 0.5;
  }
  const auto stamped = [&](double jitter, double scale)
  {
    std::vector<ArmSetPoint> points = even;
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      points[k].time = scale * points[k].time + (k % 2 == 1 ? jitter : 0.0);
    }
    return points;
  };
  std::vector<ArmSetPoint> points = stamped(0.002, 1.0);
  EXPECT_NEAR(straightenTimes(points), 0.002, 1e-12);
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    EXPECT_NEAR(points[k].time, even[k].time, 1e-12);
  }
  // Jitter below a tenth of a step does not count; speeds that are not the rates of the angles tell nothing.
  for (std::vector<ArmSetPoint> kept : { stamped(0.0007, 1.0), stamped(0.002, 1.05), stamped(0.0, 1.0) })
  {
    const double time = kept[9].time;
    EXPECT_EQ(straightenTimes(kept), 0.0);
    EXPECT_EQ(kept[9].time, time);
  }
}

TEST(SetPoints, SpeedsOfAnotherUnitOrSignAreRefused)
{
  const ArmDescription arm = readArmDescription(SHIPPED);
  const auto complaint = [&](double factor, double way)
  {
    std::vector<ArmSetPoint> points = elbowAlong(40, [&](double t) { return way * t / 0.312; });
    for (ArmSetPoint& point : points)
    {
      point.joints[2].velocity = factor * way / 0.312;
    }
    return complaintOf([&] { requireRates(points, arm, "FILE"); });
  };
  for (const double sound : { 0.55, 1.0, 1.9 })
  {
    EXPECT_EQ(complaint(sound, 0.3), "");
  }
  EXPECT_EQ(complaint(57.3, 0.3),
            "FILE: elbow: its speeds are 57.3 times the rate of its angles, allowed: 0.5 ... 2 "
            "(are they degrees/s?)");
  EXPECT_THAT(complaint(-1.0, 0.3), testing::HasSubstr("is their sign wrong?"));
  EXPECT_THAT(complaint(0.4, 0.3), testing::HasSubstr("are they missing?"));
  EXPECT_EQ(complaint(57.3, 0.09), "");  // too little motion to tell
}
}  // namespace
}  // namespace hjt
