// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "arm/set_points.hpp"
#include "gear/ratio.hpp"
#include "test/core/rods.hpp"

namespace hjt
{
namespace
{
/// From the begin of the motion [s].
void runTo(MovingArm& arm, double time)
{
  advance(arm, arm.motionBegin() + toStampLength(time));
}

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
  MovingArm whole = movingRods(ArmMotion(points));
  std::vector<MovingArm> piecewise{ movingRods(ArmMotion({ points[0], points[0] })) };
  const auto expect_same = [](const MovingArm& one, const MovingArm& other)
  {
    ASSERT_EQ(one.twin().stamp(), other.twin().stamp());
    for (std::size_t i = 0; i < 2; ++i)
    {
      EXPECT_EQ(one.twin().motion()[i].position, other.twin().motion()[i].position);
      EXPECT_EQ(one.reading(i).current, other.reading(i).current);
    }
  };
  runTo(piecewise[0], 0.0);
  for (std::size_t k = 1; k < 25; ++k)
  {
    for (MovingArm& arm : piecewise)
    {
      arm.goOn(points[k].time, points[k].joints);
      runTo(arm, points[k].time);
    }
    if (k == 10)
    {
      const MovingArm copy = piecewise[0];
      piecewise.push_back(copy);
    }
  }
  runTo(whole, points[24].time);
  expect_same(piecewise[0], whole);
  expect_same(piecewise[1], whole);
  // A payload shows, and to the copy alone.
  piecewise[1].setPayload({ 3.0, { 0.1, 0.0, 0.0 } });
  runTo(piecewise[1], points[24].time + 0.01);
  runTo(whole, points[24].time + 0.01);
  EXPECT_GT(std::abs(piecewise[1].reading(0).current - whole.reading(0).current), 0.1);
}

/// As a robot's driver it reads the motor's current with an offset, which no torque has.
TEST(MovingArm, TheCurrentThatItReadsHasAnOffset)
{
  constexpr double OFFSET = 0.05;  // [A]
  const ArmMotion rest({ { 0.0, REST }, { 1.0, REST } });
  Parameters biased = drive();
  biased.telemetry.current_offset = OFFSET;
  MovingArm with(rods("0 1 0", 2), { biased, drive() }, rest, {});
  MovingArm without = movingRods(rest);
  runTo(with, 0.01);
  runTo(without, 0.01);
  EXPECT_NEAR(with.reading(0).current, without.reading(0).current + OFFSET, 1e-12);
  EXPECT_EQ(with.reading(1).current, without.reading(1).current);
  EXPECT_EQ(with.twin().motion()[0].position, without.twin().motion()[0].position);
}

/// From rest to a set point in motion and on to rest: angles, speeds and accelerations are each other's rates, and
/// neither end moves.
TEST(MovingArm, WaysFromRestAndToRestAreSmooth)
{
  const ArmSetPoint point{ 3.0, { { 0.4, 1.2, -3.0 }, { -0.2, -0.5, 1.0 }, { 0.7, 0.0, 0.0 } } };
  for (const std::vector<ArmSetPoint>& points : { fromRest(point), toRest(point) })
  {
    const bool begins = points.back().time == point.time;
    const ArmSetPoint& rest = begins ? points.front() : points.back();
    const ArmSetPoint& there = begins ? points.back() : points.front();
    for (std::size_t i = 0; i < 3; ++i)
    {
      EXPECT_EQ(there.joints[i].position, point.joints[i].position);
      EXPECT_EQ(there.joints[i].velocity, point.joints[i].velocity);
      EXPECT_EQ(there.joints[i].acceleration, point.joints[i].acceleration);
      EXPECT_EQ(rest.joints[i].velocity, 0.0);
      EXPECT_EQ(rest.joints[i].acceleration, 0.0);
    }
    for (std::size_t k = 1; k < points.size(); ++k)
    {
      const double length = points[k].time - points[k - 1].time;
      ASSERT_GT(length, 0.0);
      for (std::size_t i = 0; i < 3; ++i)
      {
        const JointMotion& a = points[k - 1].joints[i];
        const JointMotion& b = points[k].joints[i];
        // Simpson's rule, with the middle of a cubic, is exact.
        const double middle = 0.5 * (a.velocity + b.velocity) + length / 8.0 * (a.acceleration - b.acceleration);
        EXPECT_NEAR(b.position - a.position, length / 6.0 * (a.velocity + 4.0 * middle + b.velocity), 1e-12);
        EXPECT_NEAR(b.velocity - a.velocity, 0.5 * length * (a.acceleration + b.acceleration), 2e-3);
      }
    }
  }
  EXPECT_EQ(fromRest({ 0.0, { { 0.3, 0.0, 2.0 } } }).size(), 1U);
}

/// A motion that begins at speed: the arm is there, at that speed, when it begins.
TEST(MovingArm, ItComesToAMotionThatBeginsInMotion)
{
  std::vector<ArmSetPoint> points;
  for (int k = 0; k <= 25; ++k)
  {
    points.push_back({ k / 125.0, { { 0.3 + k / 125.0, 1.0, 0.0 }, { -0.8, 0.0, 0.0 } } });
  }
  MovingArm arm = movingRods(ArmMotion(points));
  double farthest = 0.0;
  while (arm.step(arm.motionBegin() + toStampLength(0.2)))
  {
    const double time = toSeconds(arm.twin().stamp() - arm.motionBegin());
    if (time >= 0.0)
    {
      farthest = std::max(farthest, std::abs(arm.twin().motion()[0].position - 0.3 - time));
    }
  }
  EXPECT_LT(farthest, 1e-3);
  EXPECT_FALSE(arm.protectiveStop());
}

/// Set points of angles alone: to and fro they begin and end at rest, a piece of a longer motion at its speed.
TEST(MovingArm, AMotionOfAnglesAloneEndsAtRestWhereItCanStop)
{
  const auto points_of = [](double (*angle)(double), double period)
  {
    std::vector<ArmSetPoint> points;
    for (int k = 0; k <= 100; ++k)
    {
      points.push_back({ k * period, { { angle(k * period), 0.0, 0.0 } } });
    }
    fillRates(points, false, false);
    return points;
  };
  const std::vector<ArmSetPoint> wave = points_of([](double time) { return 0.2 * std::cos(M_PI * time / 0.8); }, 0.008);
  for (const ArmSetPoint& end : { wave.front(), wave.back() })
  {
    EXPECT_EQ(end.joints[0].velocity, 0.0);
    EXPECT_EQ(toRest(end).size(), 1U) << "it is held at its end";
  }
  const std::vector<ArmSetPoint> piece = points_of([](double time) { return 0.5 * time; }, 0.008);
  EXPECT_NEAR(piece.front().joints[0].velocity, 0.5, 1e-9);
  EXPECT_NEAR(piece.back().joints[0].velocity, 0.5, 1e-9);
}

/// What angle and speed ask for is limited; what is fed forward is not.
TEST(MovingArm, TheControllersFeedbackIsLimited)
{
  constexpr double LIMIT = 5.0;  // [N.m]
  std::vector<JointMotion> away = REST;
  away[0].position += 0.05;
  double most[2] = {};
  for (const bool is_limited : { false, true })
  {
    ArmDescription description = rods("0 1 0", 2);
    description.joints[0].feedback_limit = is_limited ? LIMIT : 0.0;
    MovingArm arm(description, { drive(), drive() },
                  ArmMotion({ { 0.0, REST }, { 0.1, REST }, { 0.101, away }, { 0.3, away } }), {});
    const double gain = arm.twin().drive(0).parameters().telemetry.torque_per_current;
    double fed_forward = 0.0;  // beside the current that an instant shows, which the control of before made
    for (; arm.step(arm.motionBegin() + toStampLength(0.3));
         fed_forward = arm.controller().isDue(arm.twin()) ? arm.controller().feedForward(0) : fed_forward)
    {
      if (arm.twin().stamp() > arm.motionBegin() + toStampLength(0.102))
      {
        const double feedback = gain * arm.reading(0).current - fed_forward;
        most[is_limited] = std::max(most[is_limited], std::abs(feedback));
      }
    }
    EXPECT_EQ(arm.controller().limitedControls() > 0, is_limited);
  }
  EXPECT_GT(most[0], 2.0 * LIMIT);
  EXPECT_NEAR(most[1], LIMIT, 0.02 * LIMIT);
}

/// The speed that it shows is the one that its current was made of; where none controls, that of the instant.
TEST(MovingArm, TheSpeedIsThatOfTheControl)
{
  std::vector<JointMotion> to = REST;
  to[0].position += 0.1;
  MovingArm arm = movingRods(ArmMotion({ { 0.0, REST }, { 0.2, to } }));
  const auto speed = [&]
  {
    const Twin& twin = arm.twin().drive(0);
    return twin.encoders().motor_velocity / nominalRatio(twin.parameters().gear);
  };
  double before = 0.0;
  int others = 0;  // instants between controls at which the joint has another speed
  while (arm.step(arm.motionBegin() + toStampLength(0.1003)))
  {
    ASSERT_EQ(arm.reading(0).velocity, before);  // at a control the torque of this instant is still to come
    others += speed() != before ? 1 : 0;
    before = arm.controller().isDue(arm.twin()) ? speed() : before;
  }
  EXPECT_GT(before, 0.1);
  EXPECT_GT(others, 0);
  for (int k = 0; k < 50; ++k)
  {
    arm.twin().step(MAX_STAMP);
  }
  EXPECT_EQ(arm.reading(0).velocity, speed());
}

/// Joint 0 at a steady speed, from rest: by how much it is behind its set point, over the speed [s].
double lagAtSteadySpeed(double delay)
{
  constexpr double SPEED = 0.5;  // [rad/s]
  ArmDescription description = rods("0 0 1", 2);
  description.joints[0].delay = delay;
  const auto point = [](double time, double angle, double speed) {
    return ArmSetPoint{ time, { { angle, speed, 0.0 }, { -0.8, 0.0, 0.0 } } };
  };
  MovingArm arm(
      description, { drive(), drive() },
      ArmMotion({ point(0.0, 0.3, 0.0), point(0.5, 0.3 + 0.25 * SPEED, SPEED), point(1.5, 0.3 + 1.25 * SPEED, SPEED) },
                ArmAccelerations::OF_CUBICS),
      {});
  std::vector<JointMotion> wanted(2);
  double behind = 0.0;
  int count = 0;
  while (arm.step(arm.motionBegin() + toStampLength(1.49)))
  {
    if (arm.twin().stamp() > arm.motionBegin() + toStampLength(1.2))
    {
      arm.wanted(wanted);
      behind += wanted[0].position - arm.reading(0).position;
      ++count;
    }
  }
  EXPECT_FALSE(arm.protectiveStop());
  return behind / count / SPEED;
}

/// A set point acts when its delay is over, not before and not a step late.
TEST(MovingArm, ItIsBehindItsSetPointsByTheirDelay)
{
  constexpr double CLOSE = 0.03e-3;  // an encoder's count over the speed is 0.01 ms [s]
  EXPECT_NEAR(lagAtSteadySpeed(0.0), 0.0, CLOSE);
  EXPECT_NEAR(lagAtSteadySpeed(0.5e-3), 0.5e-3, CLOSE);
  EXPECT_NEAR(lagAtSteadySpeed(0.85e-3), 0.85e-3, CLOSE);  // between two periods of the control
}

/// The set point's speed is held against the encoder's of the same time: how long that is averaged moves no angle.
TEST(MovingArm, TheWindowOfTheSpeedMakesNoLead)
{
  constexpr double ACCELERATION = 2.0;  // [rad/s^2]
  double angles[2] = {};
  for (const bool is_long : { false, true })
  {
    Parameters smooth = drive();
    smooth.sensors.velocity_window = is_long ? 10e-3 : 1e-3;
    smooth.sensors.motor_counts_per_turn = 1 << 20;
    std::vector<ArmSetPoint> points;
    for (int k = 0; k <= 50; ++k)
    {
      const double time = k / 125.0;
      points.push_back(
          { time,
            { { 0.3 + 0.5 * ACCELERATION * time * time, ACCELERATION * time, ACCELERATION }, { -0.8, 0.0, 0.0 } } });
    }
    MovingArm arm(rods("0 0 1", 2), { smooth, smooth }, ArmMotion(points), {});
    runTo(arm, 0.35);
    angles[is_long] = arm.twin().motion()[0].position;
  }
  // 4.5 ms of the speed over a gain of 20 1/s would be 450 urad.
  EXPECT_NEAR(angles[1], angles[0], 45e-6);
}

/// The integral leaves what an encoder does not see: at rest the current stands.
TEST(MovingArm, AtRestTheCurrentStands)
{
  const std::vector<JointMotion> to{ { 0.4, 0.0, 0.0 }, { -0.7, 0.0, 0.0 } };
  MovingArm arm = movingRods(ArmMotion({ { 0.0, REST }, { 0.3, to } }, ArmAccelerations::OF_CUBICS));
  double least[2] = { HUGE_VAL, HUGE_VAL };
  double most[2] = { -HUGE_VAL, -HUGE_VAL };
  while (arm.step(arm.motionBegin() + toStampLength(5.0)))
  {
    for (std::size_t i = 0; i < 2 && arm.twin().stamp() > arm.motionBegin() + toStampLength(3.0); ++i)
    {
      least[i] = std::min(least[i], arm.reading(i).current);
      most[i] = std::max(most[i], arm.reading(i).current);
      EXPECT_NEAR(arm.reading(i).position, to[i].position, 30e-6);
    }
  }
  for (std::size_t i = 0; i < 2; ++i)
  {
    EXPECT_LT(most[i] - least[i], 0.02) << i;  // [A]; a UR5's at rest: 0.01 rms
  }
}
}  // namespace
}  // namespace hjt
