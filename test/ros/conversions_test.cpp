// SPDX-License-Identifier: BSD-3-Clause
#include "messages/conversions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/channels.hpp"
#include "messages/time.hpp"
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

TEST(Time, OfAnyMessageCanBeHadAndComesBackInRange)
{
  ros::Time wire;
  wire.sec = wire.nsec = 4'294'967'295;  // more than a second of nanoseconds: it may come like that
  EXPECT_EQ(fromRosTime(wire), LAST_ROS_STAMP);
  EXPECT_EQ(toRosTime(fromRosTime(wire)), ros::Time(4'294'967'295, 999'999'999));
  EXPECT_EQ(toRosTime(std::numeric_limits<Stamp>::max()), ros::Time(4'294'967'295, 999'999'999));
  EXPECT_EQ(toRosTime(-1), ros::Time(0, 0));
  for (const double duration : { 1e10, 1e300, std::numeric_limits<double>::infinity(), std::nan("") })
  {
    EXPECT_EQ(toStampLength(duration), MAX_STAMP_LENGTH) << duration;
  }
  EXPECT_GT(LAST_ROS_STAMP + MAX_STAMP_LENGTH, LAST_ROS_STAMP);
}

class Messages : public testing::Test
{
protected:
  Messages()
  {
    twin_.commandMotorTorque(0, 0.5);
    while (twin_.step(100'000'000))
    {
    }
  }

  Parameters parameters_ = shippedParameters({ "joint.name=\"elbow\"" });
  Twin twin_{ parameters_ };
};

TEST_F(Messages, CarryEncoderAnglesAndTorquesUnderBothNames)
{
  auto message = makeJointStates(parameters_);
  EXPECT_TRUE(fillJointStates(twin_, 0, message));
  const EncoderReadings readings = twin_.encoders();
  EXPECT_EQ(message.header.frame_id, "elbow");
  EXPECT_EQ(message.header.stamp, ros::Time(0, 100'000'000));
  EXPECT_EQ(message.name, (std::vector<std::string>{ "elbow_motor", "elbow" }));
  EXPECT_EQ(message.position, (std::vector<double>{ readings.motor_angle, readings.output_angle }));
  EXPECT_EQ(message.velocity, (std::vector<double>{ readings.motor_velocity, readings.output_velocity }));
  EXPECT_EQ(message.effort, (std::vector<double>{ twin_.outputs().motor_torque, twin_.outputs().joint_torque }));
  EXPECT_GT(message.position[0], 0.1);
}

}  // namespace

// A template argument of a header's class: not in an unnamed namespace.
struct HealthListener
{
  bool is_listening{ true };
  std::vector<harmonic_joint_twin::Health> messages;
};

/// Gives the listener its messages; of the other topics none is wanted.
template <class Message>
class HealthSink
{
public:
  HealthSink(HealthListener* listener, const Channel<Message>& /*channel*/, Message first)
    : listener_(*listener), message_(std::move(first))
  {
  }
  bool isWanted() const { return std::is_same_v<Message, harmonic_joint_twin::Health> && listener_.is_listening; }

  template <class Fill>
  void write(Fill&& fill)
  {
    ASSERT_TRUE(fill(message_));
    if constexpr (std::is_same_v<Message, harmonic_joint_twin::Health>)
    {
      listener_.messages.push_back(message_);
    }
  }

private:
  HealthListener& listener_;
  Message message_;
};

namespace
{
TEST_F(Messages, SummariseTheStepsSinceTheLastHealth)
{
  HealthListener listener;
  Outputs<HealthSink> outputs(&listener, parameters_);
  const double ratio = nominalRatio(parameters_.gear);
  std::vector<double> torsions;
  std::vector<double> torques;
  twin_.push({ twin_.stamp(), InputKind::LOAD_TORQUE, 20.0 });
  const auto run = [&](Stamp length)
  {
    for (const Stamp end = twin_.stamp() + length; twin_.stamp() < end;)
    {
      twin_.commandMotorTorque(twin_.stamp(), 0.3 * std::sin(60.0 * toSeconds(twin_.stamp())));
      twin_.step(end);
      torsions.push_back(twin_.outputs().motor_angle / ratio - twin_.outputs().output_angle);
      torques.push_back(twin_.outputs().joint_torque);
      outputs.offer(twin_);
    }
  };
  run(100'000'000);
  torsions.clear();
  torques.clear();
  run(100'000'000);
  ASSERT_EQ(listener.messages.size(), 2u);
  const harmonic_joint_twin::Health& message = listener.messages.back();
  EXPECT_EQ(torques.size(), 1000u);
  EXPECT_EQ(message.torsion_min, *std::min_element(torsions.begin(), torsions.end()));
  EXPECT_EQ(message.torsion_max, *std::max_element(torsions.begin(), torsions.end()));
  EXPECT_EQ(message.joint_torque_min, *std::min_element(torques.begin(), torques.end()));
  EXPECT_EQ(message.joint_torque_max, *std::max_element(torques.begin(), torques.end()));
  EXPECT_NEAR(message.joint_torque_mean, std::accumulate(torques.begin(), torques.end(), 0.0) / 1000.0, 1e-9);
  EXPECT_LT(message.motor_torque_min, -0.25);
  EXPECT_GT(message.motor_torque_max, 0.25);
  EXPECT_LT(message.torsion_min, message.torsion_mean);
  EXPECT_LT(message.torsion_mean, message.torsion_max);

  // What passed while nobody listened is not in it.
  listener.is_listening = false;
  run(150'000'000);
  torques.clear();
  listener.is_listening = true;
  run(50'000'000);
  ASSERT_EQ(listener.messages.size(), 3u);
  EXPECT_EQ(listener.messages.back().joint_torque_max, *std::max_element(torques.begin(), torques.end()));
}

TEST_F(Messages, HoldTheForcesOfEveryTooth)
{
  auto message = makeContactForces(parameters_);
  const double* const place = message.mesh_force.data();
  EXPECT_TRUE(fillContactForces(twin_, 0, message));
  ToothForces forces = twin_.makeToothForces();
  twin_.toothForces(forces);
  EXPECT_EQ(message.wave_generator_force, forces.wave_generator_force);
  EXPECT_EQ(message.rim_tension, forces.rim_tension);
  EXPECT_EQ(message.bending_force, forces.bending_force);
  EXPECT_EQ(message.mesh_force, forces.mesh_force);
  EXPECT_EQ(message.tooth_x, forces.tooth_x);
  EXPECT_EQ(message.tooth_y, forces.tooth_y);
  EXPECT_EQ(message.mesh_force_error, twin_.health().mesh_force_error);
  EXPECT_EQ(message.mesh_force.data(), place) << "its own array, not another";
}

TEST_F(Messages, HoldTheStressOfTheFlexspline)
{
  auto message = makeStress(parameters_);
  const double* const place = message.tooth_space.data();
  EXPECT_TRUE(fillStress(twin_, 0, message));
  ToothStress stress(parameters_.gear.teeth_flexspline);
  ASSERT_TRUE(twin_.toothStress(stress));
  EXPECT_EQ(message.header.stamp, ros::Time(0, 100'000'000));
  EXPECT_EQ(message.tooth_space, stress.normal[0]);
  EXPECT_EQ(message.transition, stress.normal[1]);
  EXPECT_EQ(message.flange, stress.normal[2]);
  EXPECT_EQ(message.tooth_space.data(), place) << "its own array, not another";
  EXPECT_EQ(message.places, (std::vector<std::string>{ "tooth space", "transition", "flange" }));
  EXPECT_EQ(message.place, "tooth space");
  EXPECT_DOUBLE_EQ(message.largest, parameters_.stress.concentration[0] *
                                        std::abs(message.tooth_space[static_cast<std::size_t>(message.tooth)]));
  EXPECT_DOUBLE_EQ(message.amplitudes[0], stress.cycle(0).amplitude());
  EXPECT_DOUBLE_EQ(message.means[0], stress.cycle(0).mean());
  EXPECT_GT(message.endurance_share, 0.5);
  EXPECT_LT(message.endurance_share, 1.0) << "no load";
  EXPECT_EQ(message.endurance_share, message.endurance_shares[0]);
}

SignalIndicators someIndicators()
{
  SignalIndicators indicators;
  indicators.stamp = 5'000'000'001;
  indicators.windows = 7;
  indicators.turns = 101.0;
  indicators.point = { 100.0, -1.0, std::nan(""), 25.0, std::nan(""), std::nan(""), std::nan(""), 7.0 };
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    indicators.values[i] = 1.0 + 0.01 * static_cast<double>(i);
    indicators.uncertainty[i] = 0.1 * indicators.values[i];
  }
  indicators.values[indexOf(ScalarIndicator::LOST_MOTION)] = std::nan("");
  return indicators;
}

TEST(Indicators, GoIntoTheMessageAndBack)
{
  const SignalIndicators indicators = someIndicators();
  auto message = makeIndicators(shippedParameters());
  fillIndicators(indicators.stamp, indicators, message);
  const SignalIndicators back = readIndicators(message);
  EXPECT_EQ(back.stamp, indicators.stamp);
  EXPECT_EQ(back.windows, indicators.windows);
  EXPECT_EQ(back.turns, indicators.turns);
  EXPECT_EQ(back.point.temperature, 25.0);
  EXPECT_TRUE(std::isnan(back.point.load));
  EXPECT_TRUE(std::isnan(back.point.load_sine));
  EXPECT_EQ(back.point.inertia, 7.0);
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const bool given = std::isfinite(indicators.values[i]);
    EXPECT_EQ(std::isfinite(back.values[i]), given) << indicatorName(i);
    EXPECT_TRUE(!given || back.values[i] == indicators.values[i]) << indicatorName(i);
    EXPECT_EQ(back.uncertainty[i], indicators.uncertainty[i]) << indicatorName(i);
  }
}

TEST(Indicators, AreFiniteInTheMessageAndMarkedWhereTheyAreNotGiven)
{
  auto message = makeIndicators(shippedParameters());
  fillIndicators(0, someIndicators(), message);
  EXPECT_FALSE(message.load_valid);
  EXPECT_EQ(message.load, 0.0);
  EXPECT_TRUE(message.temperature_valid);
  ASSERT_EQ(message.names.size(), message.values.size());
  ASSERT_EQ(message.names.size(), message.valid.size());
  for (std::size_t i = 0; i < message.names.size(); ++i)
  {
    EXPECT_TRUE(std::isfinite(message.values[i])) << message.names[i];
    EXPECT_EQ(message.valid[i] == 0, message.names[i] == "lost_motion") << message.names[i];
  }
}

TEST(Indicators, AreReadByNameWhateverTheirOrder)
{
  auto message = makeIndicators(shippedParameters());
  fillIndicators(0, someIndicators(), message);
  message.names = { "torque_outer", "of_tomorrow", "efficiency" };
  const SignalIndicators back = readIndicators(message);
  EXPECT_EQ(back.values[amplitudeIndex(LineSignal::MOTOR_TORQUE, index(Line::OUTER))], message.values[0]);
  EXPECT_EQ(back[ScalarIndicator::EFFICIENCY], message.values[2]);
  EXPECT_TRUE(std::isnan(back[ScalarIndicator::KINEMATIC_ERROR]));
}

TEST(Fault, OfUnknownKindIsNamedInOneShortLine)
{
  harmonic_joint_twin::Fault message;
  message.kind = "tooth_wear\n[FATAL] [0.0]: forged " + std::string(1000, 'x');
  std::vector<Fault> steps;
  const std::string errors = readFault(message, shippedParameters(), steps);
  EXPECT_EQ(errors.find('\n'), std::string::npos);
  EXPECT_EQ(errors.rfind("kind = 'tooth_wear?[FATAL] [0.0]: forged xxx", 0), 0U) << errors;
  EXPECT_EQ(errors.find(std::string(61, 'x')), std::string::npos);
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

TEST(PublishPeriod, IsAWholeNumberOfSteps)
{
  EXPECT_EQ(publishPeriod(10.0, 10'000.0), 100'000'000);
  EXPECT_EQ(publishPeriod(1000.0, 3000.0), 999'999) << "of steps of 333 333 ns, so that an instant can be a multiple";
}
}  // namespace
}  // namespace hjt
