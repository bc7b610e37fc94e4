// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/conversions.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "harmonic_joint_twin/base/errors.hpp"
#include "ros_io/output_schedule.hpp"
#include "ros_io/time.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
const JointNames NAMES("elbow");

sensor_msgs::JointState effortMessage(const std::vector<std::string>& names, const std::vector<double>& efforts)
{
  sensor_msgs::JointState message;
  message.name = names;
  message.effort = efforts;
  return message;
}

TEST(Time, GoesThereAndBackToTheNanosecond)
{
  for (const Stamp stamp : { Stamp{ 1 }, Stamp{ 1'700'000'000'123'456'789 }, Stamp{ 999'999'999 } })
  {
    EXPECT_EQ(fromRosTime(toRosTime(stamp)), stamp);
  }
  EXPECT_EQ(toStampLength(0.1), 100'000'000);
  EXPECT_DOUBLE_EQ(toSeconds(250'000'000), 0.25);
}

TEST(JointStates, CarryEncoderAnglesAndTorquesUnderBothNames)
{
  JointOutputs outputs;
  outputs.stamp = 5'000'000'001;
  outputs.motor_angle = 100.0;
  outputs.motor_torque = 0.5;
  outputs.joint_torque = 40.0;
  EncoderReadings readings;
  readings.motor_angle = 99.0;
  readings.motor_velocity = 3.0;
  readings.output_angle = 0.98;
  readings.output_velocity = 0.03;
  auto message = makeJointStates(NAMES);
  fillJointStates(outputs, readings, message);
  EXPECT_EQ(message.header.frame_id, "elbow");
  EXPECT_EQ(message.header.stamp, ros::Time(5, 1));
  EXPECT_EQ(message.name, (std::vector<std::string>{ "elbow_motor", "elbow" }));
  EXPECT_EQ(message.position, (std::vector<double>{ 99.0, 0.98 }));
  EXPECT_EQ(message.velocity, (std::vector<double>{ 3.0, 0.03 }));
  EXPECT_EQ(message.effort, (std::vector<double>{ 0.5, 40.0 }));
}

TEST(ContactForces, KeepOneEntryPerTooth)
{
  auto message = makeContactForces(NAMES, 4);
  ToothForces forces;
  forces.mesh_force = { 1.0, -2.0, 3.0, 4.0 };
  forces.tooth_y = { 0.1, 0.2, 0.3, 0.4 };
  fillContactForces(JointOutputs{}, forces, message);
  EXPECT_EQ(message.mesh_force, forces.mesh_force);
  EXPECT_EQ(message.tooth_y, forces.tooth_y);
  EXPECT_EQ(message.rim_tension.size(), 4U);
}

TEST(Indicators, GoIntoTheMessageAndBack)
{
  SignalIndicators indicators;
  indicators.stamp = 5'000'000'001;
  indicators.windows = 7;
  indicators.turns = 101.0;
  indicators.point = { 100.0, -1.0, 30.0, 25.0 };
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    indicators.values[i] = 1.0 + 0.01 * static_cast<double>(i);
  }
  for (const LineSignal signal : { LineSignal::KINEMATIC_ERROR, LineSignal::MOTOR_TORQUE })
  {
    for (std::size_t line = 0; line < PHASE_LOCKED; ++line)  // the message has amplitude and phase
    {
      indicators.values[amplitudeIndex(signal, line)] =
          std::hypot(indicators.values[cosineIndex(signal, line)], indicators.values[sineIndex(signal, line)]);
    }
  }
  auto message = makeIndicators(NAMES);
  fillIndicators(indicators.stamp, indicators, message);
  const SignalIndicators back = readIndicators(message);
  EXPECT_EQ(back.stamp, indicators.stamp);
  EXPECT_EQ(back.windows, indicators.windows);
  EXPECT_EQ(back.turns, indicators.turns);
  EXPECT_EQ(back.point.load, indicators.point.load);
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    EXPECT_NEAR(back.values[i], indicators.values[i], 1e-12) << indicatorName(i);
  }
}

TEST(MotorTorque, IsTheEffortOfTheJointOrElseOfItsMotor)
{
  double torque = -1.0;
  EXPECT_EQ(readMotorTorque(effortMessage({ "base", "elbow" }, { 1.0, 2.0 }), NAMES, torque), EffortStatus::FOUND);
  EXPECT_EQ(torque, 2.0);
  EXPECT_EQ(readMotorTorque(effortMessage({ "elbow_motor" }, { 3.0 }), NAMES, torque), EffortStatus::FOUND);
  EXPECT_EQ(torque, 3.0);
  EXPECT_EQ(readMotorTorque(effortMessage({ "elbow_motor", "elbow" }, { 3.0, 4.0 }), NAMES, torque),
            EffortStatus::FOUND);
  EXPECT_EQ(torque, 4.0);
}

TEST(MotorTorque, IsNotTakenFromAMessageThatDoesNotGiveIt)
{
  double torque = -1.0;
  EXPECT_EQ(readMotorTorque(effortMessage({ "base" }, { 1.0 }), NAMES, torque), EffortStatus::UNKNOWN_JOINT);
  EXPECT_EQ(readMotorTorque(effortMessage({ "base", "elbow" }, { 1.0 }), NAMES, torque), EffortStatus::MISSING_EFFORT);
  EXPECT_EQ(readLoadTorque(effortMessage({ "elbow_motor" }, { 1.0 }), NAMES, torque), EffortStatus::UNKNOWN_JOINT);
  EXPECT_EQ(torque, -1.0);
}

TEST(OutputSchedule, CountsPeriodsFromTheEpoch)
{
  const OutputSchedule schedule(shippedParameters({ "publish.health_rate=10" }));
  EXPECT_EQ(schedule.period(Output::JOINT_STATES), 1'000'000);
  EXPECT_EQ(schedule.period(Output::HEALTH), 100'000'000);
  EXPECT_TRUE(schedule.isDue(Output::HEALTH, 1'700'000'000'100'000'000));
  EXPECT_FALSE(schedule.isDue(Output::HEALTH, 1'700'000'000'100'100'000));
}
}  // namespace
}  // namespace hjt
