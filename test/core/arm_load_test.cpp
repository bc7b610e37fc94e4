// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <functional>

#include "arm/unit_loads.hpp"
#include "base/statistics.hpp"
#include "identification/torque_fit.hpp"
#include "test/core/arm_support.hpp"
#include "test/support/seeded_random.hpp"

namespace hjt
{
namespace
{
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

/// Of unit loads, beside the recursion of ArmDynamics: to the rounding of torques of 10 kN.m, which 1000 kg take.
class UnitLoadsOf : public testing::Test
{
protected:
  static constexpr double MASS = 1000.0;                      // [kg]
  static constexpr double ROUNDING = 100.0 * 2.2e-16 * 10.0;  // of sums over six links, of torques a kg [N.m/kg]

  static std::vector<JointMotion> motionOfPose(int pose, bool at_rest)
  {
    std::vector<JointMotion> motion(6);
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      const double turn = 1.0 + static_cast<double>(i) + 7.0 * pose;
      const double share = at_rest ? 0.0 : 1.0;
      motion[i] = { 3.0 * std::sin(turn), 2.0 * share * std::cos(2.0 * turn), 4.0 * share * std::sin(3.0 * turn) };
    }
    return motion;
  }

  /// Twenty motions of an arm, with the torques of its unit loads.
  static void inPoses(const ArmDescription& arm, bool at_rest,
                      const std::function<void(const std::vector<JointMotion>&, const Eigen::MatrixXd&)>& visit)
  {
    UnitLoads unit(arm);
    Eigen::MatrixXd columns(6, UnitLoads::COLUMNS);
    for (int pose = 0; pose < 20; ++pose)
    {
      const std::vector<JointMotion> motion = motionOfPose(pose, at_rest);
      unit.torques(motion, columns);
      visit(motion, columns);
    }
  }

  /// Column by column: torques of `with` less those of `without`, by `share`.
  static void expectColumn(const Eigen::MatrixXd& columns, Eigen::Index column, const std::vector<double>& with,
                           const std::vector<double>& without, double share)
  {
    for (std::size_t i = 0; i < with.size(); ++i)
    {
      const double torque = columns(static_cast<Eigen::Index>(i), column);
      EXPECT_NEAR(torque, (with[i] - without[i]) / share, ROUNDING * std::max(1.0, std::abs(torque)))
          << "joint " << i << ", column " << column;
    }
  }

  /// Of a UR5, or of one whose third joint slides, on a slope.
  static ArmDescription onASlope(LinkMotion third)
  {
    ArmDescription arm = shipped("ur5");
    std::find_if(arm.links.begin() + 2, arm.links.end(),
                 [](const ArmLink& link) { return link.motion == LinkMotion::TURNS; })
        ->motion = third;
    arm.gravity = { 1.0, -3.0, -9.0 };
    return arm;
  }

  /// A payload's torques are linear in its mass and moments, but for its inertia, which both sides of a centre share.
  static void expectPayloads(const ArmDescription& arm)
  {
    ArmDynamics dynamics(arm);
    const auto expect = [&](const std::vector<JointMotion>& motion, const Eigen::MatrixXd& columns)
    {
      const auto torques = [&](const Payload& payload)
      {
        std::vector<double> found(motion.size());
        dynamics.setPayload(payload);
        dynamics.torques(motion, found);
        return found;
      };
      expectColumn(columns, 0, torques({ MASS, {} }), torques({}), MASS);
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        std::array<double, 3> centre{};
        std::array<double, 3> opposite{};
        centre[axis] = 1.0;
        opposite[axis] = -1.0;
        expectColumn(columns, 1 + static_cast<Eigen::Index>(axis), torques({ MASS, centre }),
                     torques({ MASS, opposite }), 2.0 * MASS);
      }
    };
    inPoses(arm, false, expect);
  }
};

/// Of links whose torques are some hundred N.m, with all that a description may have.
TEST_F(UnitLoadsOf, TheArmsOwnAreTheRecursions)
{
  for (const LinkMotion third : { LinkMotion::TURNS, LinkMotion::SLIDES })
  {
    ArmDescription arm = onASlope(third);
    arm.drag = 20.0;
    UnitLoads unit(arm);
    ArmDynamics dynamics(arm);
    for (const Payload& payload : { Payload{}, Payload{ 3.0, { 0.05, -0.02, 0.1 } } })
    {
      unit.setPayload(payload);
      dynamics.setPayload(payload);
      for (int pose = 0; pose < 20; ++pose)
      {
        const std::vector<JointMotion> motion = motionOfPose(pose, false);
        std::vector<double> found(motion.size());
        unit.own(motion, found);
        EXPECT_THAT(found, testing::Pointwise(testing::DoubleNear(1e-10), torquesOf(dynamics, motion)));
      }
    }
  }
}

TEST_F(UnitLoadsOf, PayloadsAreTheirsToTheRounding)
{
  expectPayloads(shipped("ur5"));
  expectPayloads(onASlope(LinkMotion::SLIDES));
}

TEST_F(UnitLoadsOf, GravityIsThatOfLinksAndPayload)
{
  constexpr double MOST = 1000.0;  // [m/s^2]
  ArmDescription arm = shipped("ur5");
  arm.payload = { 3.0, { 0.05, -0.02, 0.1 } };
  EXPECT_NEAR(UnitLoads(arm).linksMass() + 3.0, ArmDynamics(arm).mass(), 1e-12);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    arm.gravity = {};
    arm.gravity[axis] = MOST;
    ArmDynamics dynamics(arm);
    inPoses(arm, true,
            [&](const std::vector<JointMotion>& motion, const Eigen::MatrixXd& columns)
            {
              expectColumn(columns, 4 + static_cast<Eigen::Index>(axis), torquesOf(dynamics, motion),
                           std::vector<double>(motion.size()), MOST);
            });
  }
}

/// A force across gravity is the weight of a kilogram where gravity lies across, whichever way both directions point.
TEST_F(UnitLoadsOf, ForcesAcrossGravityAreWeightsThatLieAcross)
{
  const ArmDescription arm = shipped("ur5");
  ArmDescription across = arm;
  std::array<Eigen::MatrixXd, 2> weights{ Eigen::MatrixXd(6, UnitLoads::COLUMNS),
                                          Eigen::MatrixXd(6, UnitLoads::COLUMNS) };
  const auto expect = [&](const std::vector<JointMotion>& motion, const Eigen::MatrixXd& columns)
  {
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
      across.gravity = {};
      across.gravity[axis] = 1.0;
      UnitLoads(across).torques(motion, weights[axis]);
    }
    const Eigen::MatrixXd forces = columns.rightCols<2>() * columns.rightCols<2>().transpose();
    const Eigen::MatrixXd expected =
        weights[0].col(0) * weights[0].col(0).transpose() + weights[1].col(0) * weights[1].col(0).transpose();
    EXPECT_TRUE(forces.isApprox(expected, 1e-12)) << forces << "\n" << expected;
  };
  inPoses(arm, true, expect);
}

/// The joints give the power that the drag takes: its force times the tip's speed, by differences of the tip's place.
TEST_F(UnitLoadsOf, ADragTakesThePowerOfItsForce)
{
  constexpr double STEP = 1e-6;  // [s]
  const ArmDescription arm = shipped("ur5");
  ArmDynamics dynamics(arm);
  const auto expect = [&](const std::vector<JointMotion>& motion, const Eigen::MatrixXd& columns)
  {
    std::vector<JointMotion> later = motion;
    std::vector<JointMotion> before = motion;
    double power = 0.0;
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      later[i].position += STEP * motion[i].velocity;
      before[i].position -= STEP * motion[i].velocity;
      power += columns(static_cast<Eigen::Index>(i), 7) * motion[i].velocity;
    }
    const Eigen::Vector3d there(dynamics.toolPose(later).position.data());
    const double speed = (there - Eigen::Vector3d(dynamics.toolPose(before).position.data())).norm() / (2.0 * STEP);
    EXPECT_NEAR(power, speed * speed / std::hypot(speed, DRAG_SPEED), 1e-7 * speed);
  };
  inPoses(arm, false, expect);
}

/// A drag of the description is so many times the unit's.
TEST_F(UnitLoadsOf, ADragIsTheRecursionsToo)
{
  constexpr double FORCE = 1e4;  // [N]
  const ArmDescription arm = shipped("ur5");
  ArmDescription dragged = arm;
  dragged.drag = FORCE;
  ArmDynamics without(arm);
  ArmDynamics with(dragged);
  inPoses(arm, false,
          [&](const std::vector<JointMotion>& motion, const Eigen::MatrixXd& columns)
          { expectColumn(columns, 7, torquesOf(with, motion), torquesOf(without, motion), FORCE); });
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
  const auto take = [&](const ArmSample& ready)
  {
    const double time = ready.joints.front().time;
    const double speed = 0.5 * RATE * std::cos(RATE * time);
    const double acceleration = -0.5 * RATE * RATE * std::sin(RATE * time);
    const std::vector<double> expected =
        torquesOf(dynamics, motionOf(swing(time), { 0.0, speed, -speed }, { 0.0, acceleration, -acceleration }));
    const bool is_inside = (time > 0.11 && time < 1.9) || (time > 2.31 && time < 3.85);
    worst = is_inside ? std::max(worst, std::abs(ready.torques[1] - expected[1])) : worst;
    gaps += ready.joints.front().after_gap ? 1 : 0;
    ++samples;
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
    popAll(load, take);
  }
  EXPECT_FALSE(load.push(rowsOf(3.9, swing(3.9)))) << "earlier than the row before";
  EXPECT_FALSE(load.push(rowsOf(5.0, { std::nan("") })));
  popAll(load, take, true);
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

  std::size_t compared = 0;
  for (int i = 0; i < 400; ++i)
  {
    const double time = 0.016 * i + (i % 2 == 1 ? -0.004 : 0.004);
    exact.push(swinging(time, time, false));
    load.push(swinging(time, 0.016 * i, with_velocity));
    popAll(exact, [&](const ArmSample& sample) { expected.push_back(sample.torques[2]); });
    popAll(load,
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
    popAll(load,
           [&](const ArmSample& sample)
           {
             largest = sample.joints[2].time > 1.0 ? std::max(largest, std::abs(sample.own[2].vibration)) : 0.0;
             ++samples;
           });
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
    popAll(load, [&](const ArmSample& sample) { torques.push_back(sample.torques[2]); });
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
  const std::vector<double> weight = torquesOf(dynamics, motionOf(BENT));
  const std::vector<double> unit = torquesOf(dynamics, motionOf(BENT, {}, { 0.0, 1.0 }));
  const double inertia = unit[1] - weight[1];
  double in_phase = 0.0;
  double reference = 0.0;
  double slow = 0.0;
  for (int i = 0; i < 500; ++i)
  {
    Angles angles = BENT;
    angles[1] += SIZE * std::sin(RATE * 0.008 * i);
    load.push(rowsOf(0.008 * i, angles));
    popAll(load,
           [&](const ArmSample& sample)
           {
             const double expected = -inertia * SIZE * RATE * RATE * std::sin(RATE * sample.joints[1].time);
             in_phase += sample.own[1].vibration * expected;
             reference += expected * expected;
             slow = std::max(slow, std::abs(sample.torques[1] - weight[1]));
           });
  }
  EXPECT_NEAR(in_phase / reference, 0.42, 0.02) << "of it, by the parabola over 72 ms";
  EXPECT_LT(slow, 0.3 * inertia * SIZE * RATE * RATE);
}

TEST(ArmLoad, AllocatesNothingAfterConstruction)
{
  ArmLoad load(shipped("ur5"));
  std::vector<MotionRow> row = rowsOf(0.0, BENT);
  const std::size_t before = allocationCount();
  for (int i = 0; i < 1000; ++i)
  {
    for (MotionRow& joint : row)
    {
      joint.time = 0.002 * i;
    }
    load.push(row);
    popAll(load, [](const ArmSample&) {});
  }
  EXPECT_EQ(allocationCount(), before);
}

/// By the products of the definition.
double directRows(const Eigen::VectorXd& residuals)
{
  const Eigen::Index rows = residuals.size();
  double length = 1.0;
  for (Eigen::Index lag = 1; lag < rows / 4; ++lag)
  {
    const double product = residuals.head(rows - lag).dot(residuals.tail(rows - lag));
    if (product <= 0.0)
    {
      break;
    }
    length += 2.0 * product / residuals.squaredNorm();
  }
  return length;
}

TEST(CorrelationRows, AreThoseOfTheDefinition)
{
  SeededRandom engine(1);
  for (const double memory : { 0.0, 0.5, 0.95, 0.999 })
  {
    for (const Eigen::Index rows : { 5, 100, 1000, 3001 })
    {
      Eigen::VectorXd residuals(rows);
      double last = 0.0;
      for (double& residual : residuals)
      {
        residual = last = memory * last + engine.normal();
      }
      EXPECT_NEAR(correlationRows(residuals), directRows(residuals), 1e-9 * directRows(residuals)) << memory;
    }
  }
  EXPECT_EQ(correlationRows(Eigen::VectorXd::Zero(100)), 1.0);
}

/// A product for each lag of half an hour at 125 Hz would take a minute.
TEST(CorrelationRows, TakeMuchLessThanTheDefinitionWhereAllRowsAreAlike)
{
  constexpr Eigen::Index ROWS = 225'000;
  EXPECT_NEAR(correlationRows(Eigen::VectorXd::Ones(ROWS)), 1.0 + 2.0 * ROWS / 4.0 * 7.0 / 8.0, 2.0);
}
}  // namespace
}  // namespace hjt
