// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <functional>

#include "arm/recording_fit.hpp"
#include "test/core/arm_support.hpp"
#include "test/support/seeded_random.hpp"

namespace hjt
{
namespace
{
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::size_t JOINTS = 6;
constexpr double RATIO = 101.0;

/// What a made-up UR5 gives of one joint at one time.
struct Given
{
  double time{};
  double position{};
  double velocity{};
  double effort{};
};

/// A UR5 that swings all joints for 40 s at 125 Hz, each at its own rate, and draws what load, friction and some noise
/// take.
class Robot
{
public:
  /// `change`: of what is given of a joint.
  explicit Robot(std::function<void(std::size_t joint, Given& given)> change = {}) : change_(std::move(change)) {}

  void setEffort(const std::string& unit) { unit_ = unit; }
  void holdStill() { moves_ = false; }

  RecordingFit fit() const
  {
    const ArmDescription arm = readArmDescription(HJT_TEST_CONFIG_DIR "/arms/ur5.yaml");
    std::vector<Parameters> parameters;
    for (const ArmJoint& joint : arm.joints)
    {
      ParameterMap map = armJointParameters(joint, HJT_TEST_CONFIG_DIR, "");
      readAssignment("telemetry.effort=" + unit_, map);
      parameters.push_back(parseParameters(map));
    }
    RecordingFit fit(parameters);
    // True loads, then what is given: those of the given angles may be wrong.
    const std::vector<std::vector<double>> torques = trueLoads(arm);
    ArmLoad load(arm);
    std::vector<MotionRow> rows(JOINTS);
    SeededRandom engine(3);
    const auto take = [&](const ArmSample& sample) { fit.update(sample.joints, sample.torques); };
    for (std::size_t row = 0; row < ROWS; ++row)
    {
      for (std::size_t i = 0; i < JOINTS; ++i)
      {
        Given given = motion(0.008 * static_cast<double>(row), i);
        const double friction = std::copysign(8.0, given.velocity) + 6.0 * given.velocity;
        given.effort =
            (torques[row][i] + friction) / parameters[i].telemetry.torque_per_current + 0.1 * engine.normal();
        if (change_)
        {
          change_(i, given);
        }
        rows[i].time = given.time;
        rows[i].position = given.position;
        rows[i].recorded_velocity = given.velocity;
        rows[i].current = given.effort * currentOf(unit_, parameters[i]);
      }
      load.push(rows);
      popAll(load, take);
    }
    popAll(load, take, true);
    return fit;
  }

private:
  static constexpr int ROWS = 5000;

  Given motion(double time, std::size_t i) const
  {
    const double rate = 0.7 + 0.17 * static_cast<double>(i);
    const double size = moves_ ? 0.6 : 0.0;
    Given given;
    given.time = time;
    given.position = BENT[i] + size * std::sin(rate * time);
    given.velocity = size * rate * std::cos(rate * time);
    return given;
  }

  /// By row, of all joints [N.m].
  std::vector<std::vector<double>> trueLoads(const ArmDescription& arm) const
  {
    ArmLoad load(arm);
    std::vector<std::vector<double>> torques;
    std::vector<MotionRow> rows(JOINTS);
    const auto keep = [&](const ArmSample& sample) { torques.push_back(sample.torques); };
    for (int row = 0; row < ROWS; ++row)
    {
      for (std::size_t i = 0; i < JOINTS; ++i)
      {
        const Given given = motion(0.008 * row, i);
        rows[i].time = given.time;
        rows[i].position = given.position;
      }
      load.push(rows);
      popAll(load, keep);
    }
    popAll(load, keep, true);
    return torques;
  }

  static double currentOf(const std::string& unit, const Parameters& parameters)
  {
    const double gain = parameters.telemetry.torque_per_current;
    return unit == "current" ? 1.0 : unit == "joint_torque" ? 1.0 / gain : RATIO / gain;
  }

  std::function<void(std::size_t, Given&)> change_;
  std::string unit_{ "current" };
  bool moves_{ true };
};

std::vector<std::string> kinds(const std::vector<RecordingFinding>& findings)
{
  std::vector<std::string> kinds;
  for (const RecordingFinding& finding : findings)
  {
    kinds.push_back(finding.kind);
  }
  return kinds;
}

/// Changes what is given of the elbow alone.
Robot withElbow(const std::function<void(Given&)>& change)
{
  return Robot(
      [change](std::size_t joint, Given& given)
      {
        if (joint == ELBOW)
        {
          change(given);
        }
      });
}

void expectOnlyElbow(const RecordingFit& fit, const std::string& kind, bool stops)
{
  EXPECT_THAT(kinds(fit.ofArm()), IsEmpty());
  const std::vector<Misfit> misfits = fit.whyNotJudged();
  for (std::size_t i = 0; i < JOINTS; ++i)
  {
    const std::vector<std::string> expected(i == ELBOW ? 1 : 0, kind);
    EXPECT_EQ(kinds(fit.ofJoint(i)), expected) << i;
    EXPECT_EQ(misfits[i].exists(), i == ELBOW && stops) << i << ": " << misfits[i].clause;
  }
}

void expectNothing(const RecordingFit& fit)
{
  EXPECT_THAT(kinds(fit.ofArm()), IsEmpty());
  for (std::size_t i = 0; i < JOINTS; ++i)
  {
    EXPECT_THAT(kinds(fit.ofJoint(i)), IsEmpty()) << i;
  }
}

TEST(RecordingFit, ASoundRecordingFits)
{
  const RecordingFit fit = Robot().fit();
  expectNothing(fit);
  EXPECT_NEAR(fit.stampFactor().value, 1.0, 0.005);
  EXPECT_NEAR(fit.effort().factor.value, 1.0, 0.05);
  EXPECT_NEAR(fit.timeFit(ELBOW).lag().value, 0.0, 0.005);
  EXPECT_NEAR(fit.reach(ELBOW).most_angle, 1.3, 0.01);
  EXPECT_TRUE(fit.isSettled());
}

TEST(RecordingFit, StampsOfAnotherPeriodAreFound)
{
  for (const double factor : { 0.5, 2.0, 4.0, 1.05 })
  {
    const RecordingFit fit = Robot([factor](std::size_t, Given& given) { given.time /= factor; }).fit();
    EXPECT_THAT(kinds(fit.ofArm()), ElementsAre("stamps")) << factor;
    EXPECT_NEAR(fit.stampFactor().value, factor, 0.01 * factor);
    EXPECT_THAT(fit.whyNotJudged()[ELBOW].clause, testing::HasSubstr("--time-scale"));
  }
}

TEST(RecordingFit, RowsTooFarApartAreFound)
{
  const RecordingFit fit = Robot([](std::size_t, Given& given) { given.time *= 1000.0; }).fit();
  EXPECT_THAT(kinds(fit.ofArm()), ElementsAre("period"));
  EXPECT_THAT(fit.whyNotJudged()[ELBOW].clause, testing::HasSubstr("stamps are of another unit"));
}

TEST(RecordingFit, LostRowsDoNotLookLikeAnotherPeriod)
{
  int row = 0;
  // A twentieth of a second is missing every two seconds, and the stamps do not show it.
  const RecordingFit fit = Robot(
                               [&row](std::size_t joint, Given& given)
                               {
                                 row += joint == 0 ? 1 : 0;
                                 given.time -= 0.05 * std::floor(row / 250.0);
                               })
                               .fit();
  EXPECT_THAT(kinds(fit.ofArm()), IsEmpty());
  EXPECT_NEAR(fit.stampFactor().value, 1.0, 0.02);
}

TEST(RecordingFit, VelocityOfAnotherTimeSignOrUnitIsFound)
{
  std::vector<double> last;
  const Robot lagging = withElbow(
      [&](Given& given)
      {
        last.push_back(given.velocity);
        given.velocity = last[last.size() > 15 ? last.size() - 16 : 0];
      });
  const RecordingFit fit = lagging.fit();
  EXPECT_NEAR(fit.timeFit(ELBOW).lag().value, 15 * 0.008, 0.01);
  expectOnlyElbow(fit, "lag", true);

  expectOnlyElbow(withElbow([](Given& given) { given.velocity *= -1.0; }).fit(), "velocity_sign", true);
  expectOnlyElbow(withElbow([](Given& given) { given.velocity *= 57.2958; }).fit(), "velocity_unit", false);
  expectOnlyElbow(withElbow([](Given& given) { given.velocity *= 1.3; }).fit(), "velocity_scale", true);
  expectOnlyElbow(withElbow([](Given& given) { given.velocity = 0.0; }).fit(), "velocity_zero", false);
  expectOnlyElbow(withElbow([](Given& given) { given.velocity = std::nan(""); }).fit(), "no_velocity", false);
}

TEST(RecordingFit, AnglesInDegreesAreFound)
{
  const RecordingFit fit = Robot(
                               [](std::size_t, Given& given)
                               {
                                 given.position *= 57.2958;
                                 given.velocity *= 57.2958;
                               })
                               .fit();
  EXPECT_THAT(kinds(fit.ofArm()), ElementsAre("angle_unit"));
}

TEST(RecordingFit, ADeadEffortIsFoundAndDoesNotCountForTheUnit)
{
  const RecordingFit zero = withElbow([](Given& given) { given.effort = 0.0; }).fit();
  expectOnlyElbow(zero, "effort_constant", true);
  EXPECT_THAT(zero.whyNotJudged()[ELBOW].clause, testing::HasSubstr("zero"));
  EXPECT_NEAR(zero.effort().factor.value, 1.0, 0.05);
  expectOnlyElbow(withElbow([](Given& given) { given.effort = 1.5; }).fit(), "effort_constant", true);
  expectOnlyElbow(withElbow([](Given& given) { given.effort *= given.time < 30.0 ? 1.0 : 0.0; }).fit(),
                  "effort_constant", true);
}

TEST(RecordingFit, UnitOfTheEffortIsFound)
{
  constexpr std::array<double, JOINTS> GAINS{ 10.7, 10.7, 10.7, 10.21, 11.9, 11.92 };
  const auto at_joint = [&](std::size_t joint, Given& given) { given.effort *= GAINS[joint]; };
  const auto at_motor = [&](std::size_t joint, Given& given) { given.effort *= GAINS[joint] / RATIO; };
  const RecordingFit joint = Robot(at_joint).fit();
  EXPECT_THAT(kinds(joint.ofArm()), ElementsAre("effort_unit"));
  EXPECT_EQ(joint.effort().unit, EffortUnit::JOINT_TORQUE);
  EXPECT_THAT(joint.whyNotJudged()[0].clause, testing::HasSubstr("telemetry.effort: joint_torque"));
  const RecordingFit motor = Robot(at_motor).fit();
  EXPECT_THAT(kinds(motor.ofArm()), ElementsAre("effort_unit"));
  EXPECT_EQ(motor.effort().unit, EffortUnit::MOTOR_TORQUE);

  Robot told(at_joint);
  told.setEffort("joint_torque");
  expectNothing(told.fit());
  Robot told_motor(at_motor);
  told_motor.setEffort("motor_torque");
  expectNothing(told_motor.fit());
  Robot wrong;
  wrong.setEffort("joint_torque");
  EXPECT_EQ(wrong.fit().effort().unit, EffortUnit::CURRENT);
  EXPECT_THAT(kinds(wrong.fit().ofArm()), ElementsAre("effort_unit"));
}

TEST(RecordingFit, EffortsInMilliamperesAreNamed)
{
  const RecordingFit fit = Robot([](std::size_t, Given& given) { given.effort *= 1000.0; }).fit();
  EXPECT_THAT(kinds(fit.ofArm()), ElementsAre("effort_unit"));
  EXPECT_THAT(fit.whyNotJudged()[0].clause, testing::HasSubstr("divide it by 1000"));
}

TEST(RecordingFit, AnotherGainIsNoOtherUnit)
{
  expectNothing(Robot([](std::size_t, Given& given) { given.effort *= 1.6; }).fit());
  const RecordingFit fit = Robot([](std::size_t, Given& given) { given.effort *= 3.5; }).fit();
  EXPECT_THAT(kinds(fit.ofArm()), ElementsAre("gain"));
  EXPECT_THAT(fit.whyNotJudged()[0].clause, testing::HasSubstr("another arm, gain, payload or mounting"));
  EXPECT_EQ(fit.whyNotJudged()[0].reason, Reason::LOAD_WRONG);
}

TEST(RecordingFit, AtRestNothingIsKnown)
{
  Robot still;
  still.holdStill();
  const RecordingFit fit = still.fit();
  EXPECT_THAT(kinds(fit.ofArm()), IsEmpty());
  EXPECT_THAT(kinds(fit.ofJoint(ELBOW)), ElementsAre("at_rest"));
  EXPECT_THAT(fit.whyNotJudged()[ELBOW].clause, "");
  EXPECT_FALSE(std::isfinite(fit.stampFactor().value));
  EXPECT_FALSE(std::isfinite(fit.effort().factor.value));
  EXPECT_FALSE(fit.isSettled());
}

TEST(RecordingFit, UpdateAllocatesNothingAndResetForgets)
{
  RecordingFit fit = Robot().fit();
  std::vector<MotionSample> samples(JOINTS);
  const std::vector<double> torques(JOINTS, 3.0);
  const std::size_t before = allocationCount();
  for (int row = 0; row < 1000; ++row)
  {
    for (MotionSample& sample : samples)
    {
      sample.time = 100.0 + 0.008 * row;
      sample.velocity = 0.3;
      sample.recorded_velocity = 0.3;
    }
    fit.update(samples, torques);
  }
  EXPECT_EQ(allocationCount(), before);
  fit.reset();
  EXPECT_FALSE(std::isfinite(fit.stampFactor().value));
  EXPECT_EQ(fit.reach(ELBOW).rows, 0U);
}
}  // namespace
}  // namespace hjt
