// SPDX-License-Identifier: BSD-3-Clause
// Which arm rows are of, while they come.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>
#include <thread>
#include <utility>

#include "arm/arm_watch.hpp"
#include "gear/angle.hpp"
#include "test/core/arm_support.hpp"
#include "test/core/test_parameters.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
namespace
{
ArmCandidate candidate(const std::string& name)
{
  const ArmDescription arm = shipped(name);
  return { name, arm, drives(arm), 0.0 };
}

const std::vector<ArmCandidate>& candidates()
{
  static const std::vector<ArmCandidate> CANDIDATES{ candidate("ur3"), candidate("ur5"), candidate("ur10") };
  return CANDIDATES;
}

/// Rows of a UR5 in motion, whose shoulder has `friction` more [A], currents times `size`.
std::vector<std::vector<MotionRow>> rowsOfUr5(double seconds, double friction = 0.0, double size = 1.0)
{
  constexpr double PERIOD = 0.02;  // [s]
  const ArmCandidate& arm = candidates()[1];
  ArmDynamics dynamics(arm.arm);
  std::vector<MotionDriven> twins(arm.joints.begin(), arm.joints.end());
  std::vector<std::vector<MotionRow>> rows;
  for (int row = 0; row * PERIOD < seconds; ++row)
  {
    const double time = row * PERIOD;
    const std::vector<JointMotion> motion = swingAt(time);
    const std::vector<double> torques = torquesOf(dynamics, motion);
    std::vector<MotionRow>& at = rows.emplace_back(motion.size());
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      MotionSample sample = sampleOf(motion[i], time);
      at[i].time = time;
      at[i].position = sample.position;
      at[i].recorded_velocity = sample.velocity;
      sample.load = torques[i];
      sample.after_gap = row == 0;
      const double more = i == 1 ? std::copysign(friction, sample.velocity) : 0.0;
      at[i].current = size * (twins[i].step(sample).current + more);
    }
  }
  return rows;
}

std::vector<ArmFit> ranked(const std::vector<std::vector<MotionRow>>& rows)
{
  return rankArms(
      candidates(),
      [&](const VisitArmRows& visit)
      {
        for (const std::vector<MotionRow>& row : rows)
        {
          visit(row);
        }
      },
      false);
}

/// Waits for what is looked for; whether it was found.
bool settles(ArmWatch& watch)
{
  constexpr int PATIENCE = 1200;
  for (int k = 0; k < PATIENCE && !watch.look(); ++k)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return watch.isSettled();
}

/// Friction of a joint is no other arm.
TEST(BetterArm, ContradictsOrIsNotLookedFor)
{
  constexpr double WORN = 3.0;
  const std::vector<ArmFit> sound = ranked(rowsOfUr5(30.0));
  const std::vector<ArmFit> worn = ranked(rowsOfUr5(30.0, WORN));
  EXPECT_EQ(sound.front().arm, "ur5");
  EXPECT_EQ(worn.front().arm, "ur5");
  EXPECT_LT(worn.front().cost, worn[1].cost - ArmFit::CONTRADICTED);
  std::size_t asked = 0;
  const auto better = [&](const std::string& own, const std::vector<ArmFit>& of)
  {
    asked = 0;
    return betterArm(own, { "ur3", "ur5", "ur10" },
                     [&](const std::vector<std::string>& names)
                     {
                       asked += names.size();
                       std::vector<ArmFit> fits;
                       std::copy_if(of.begin(), of.end(), std::back_inserter(fits),
                                    [&](const ArmFit& fit)
                                    { return std::find(names.begin(), names.end(), fit.arm) != names.end(); });
                       return fits;
                     });
  };
  EXPECT_EQ(better("ur10", worn), "ur5");
  EXPECT_EQ(asked, 3U);
  EXPECT_EQ(better("ur5", worn), "");
  EXPECT_EQ(better("mine", worn), "");
  EXPECT_EQ(asked, 0U);
  // None can explain more than all: the others are not tried.
  EXPECT_EQ(better("ur5", sound), "");
  EXPECT_EQ(asked, 1U);
}

TEST(RankArms, CurrentsOfHalfTheSizeAreNoSmallerArm)
{
  const std::vector<ArmFit> half = ranked(rowsOfUr5(30.0, 0.0, 0.5));
  EXPECT_EQ(half.front().arm, "ur5");
  EXPECT_NEAR(half.front().size, 0.5, 0.03);
  EXPECT_EQ(ranked(rowsOfUr5(30.0)).front().size, 1.0);
}

TEST(ArmWatch, AnswersAfterHalfAMinuteOfMotion)
{
  constexpr double REST = 60.0;  // [s]
  ArmWatch watch(candidates, "ur10");
  std::vector<std::vector<MotionRow>> rows = rowsOfUr5(31.0);
  std::vector<MotionRow> still = rows.front();
  for (double time = 0.0; time < REST; time += 0.02)
  {
    still.front().time = time;
    watch.add(still);
    EXPECT_FALSE(watch.look());
  }
  for (std::vector<MotionRow>& row : rows)
  {
    const bool is_early = row.front().time < 28.0;  // a second of the rest counts
    for (MotionRow& joint : row)
    {
      joint.time += REST;
    }
    watch.add(row);
    EXPECT_FALSE(is_early && watch.look());
  }
  EXPECT_TRUE(settles(watch));
  EXPECT_EQ(watch.other(), "ur5");
}

TEST(ArmWatch, ForgetsWithItsRowsWhatWasAskedOfThem)
{
  ArmWatch watch(candidates, "ur10");

  const auto add = [&watch]
  {
    for (const std::vector<MotionRow>& row : rowsOfUr5(31.0))
    {
      watch.add(row);
    }
  };
  add();
  settles(watch);
  ASSERT_EQ(watch.other(), "ur5");
  watch.reset();
  EXPECT_EQ(watch.other(), "");
  EXPECT_FALSE(watch.isSettled());
  add();
  watch.reset();  // before the answer has come
  for (int k = 0; k < 100; ++k)
  {
    EXPECT_FALSE(watch.look());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(watch.other(), "");
  add();
  settles(watch);
  EXPECT_EQ(watch.other(), "ur5");
}

TEST(ArmWatch, KeepsNoRowsInWhichNoMotionIsSeen)
{
  ArmWatch watch(candidates, "ur10");
  std::vector<MotionRow> row(6);
  const auto add = [&]
  {
    row.front().time += 0.2;  // [s]
    row.front().position += 0.1;
    watch.add(row);
  };
  add();
  const std::size_t before = allocationCount();
  for (int k = 0; k < 1000; ++k)
  {
    add();
  }
  EXPECT_EQ(allocationCount(), before);
}

TEST(NameOtherArm, LeavesReasonsThatAreNotOfTheLoad)
{
  std::vector<Misfit> misfits{ {}, { Reason::LOAD_WRONG, "the load" }, { Reason::STAMPS, "the stamps" } };
  EXPECT_TRUE(mayBeOtherArm(misfits));
  nameOtherArm("ur16e", misfits);
  EXPECT_THAT(misfits[0].clause, testing::HasSubstr("may be a ur16e"));
  EXPECT_EQ(misfits[1].reason, Reason::LOAD_WRONG);
  EXPECT_THAT(misfits[1].clause, testing::HasSubstr("may be a ur16e"));
  EXPECT_EQ(misfits[2].clause, "the stamps");
}

/// Six that fit.
JudgedJoints judgedJoints()
{
  JudgedJoints judged;
  judged.misfits.resize(6);
  judged.frictions.resize(6);
  judged.measured.assign(6, true);
  return judged;
}
const JudgedJoints JUDGED = judgedJoints();
const Payload CARRIED{ 3.0, { 0.0, 0.03, 0.08 } };
constexpr double LONG = 40.0;  // more than the motion after which a payload is looked for [s]

/// That arm, configured with that payload.
ArmDescription configured(ArmDescription arm, const Payload& payload)
{
  arm.payload = payload;
  return arm;
}

/// An arm in motion, its currents those of its twins with what it carries, and the watch beside it.
struct WatchedArm
{
  void move(double begin, double seconds, const Payload& carried)
  {
    ArmDescription with = arm;
    with.payload = carried;
    with.gravity = mounted;
    ArmDynamics loaded(with);
    ArmDynamics expected(watch.arm());
    ArmSample sample;
    sample.joints.resize(arm.joints.size());
    constexpr double PERIOD = 0.025;  // [s]
    for (int row = 0; row * PERIOD < seconds; ++row)
    {
      const double time = begin + PERIOD * row;
      const std::vector<JointMotion> motion = swingAt(time);
      const std::vector<double> torques = torquesOf(loaded, motion);
      sample.torques = torquesOf(expected, motion);
      for (std::size_t i = 0; i < motion.size(); ++i)
      {
        MotionSample& joint = sample.joints[i];
        joint = sampleOf(motion[i], time);
        MotionSample own = joint;
        own.load = torques[i];
        own.after_gap = row == 0;
        const MotionPrediction current = drives[i].step(own);
        const double more = (friction - 1.0) * current.friction_torque / parameters[i].telemetry.torque_per_current;
        joint.current = i == silent ? 0.0 : factors[i] * (current.current + more);
      }
      watch.add(sample);
    }
  }

  void carry(const Payload& carried, double seconds)
  {
    move(end, seconds, carried);
    end += seconds;
  }

  /// Whether another load counts after that motion. `joints`: what is found of them.
  bool moved(const Payload& carried, const JudgedJoints& joints = JUDGED, double seconds = LONG)
  {
    carry(carried, seconds);
    return looked(joints);
  }

  /// Whether another load counts after a look, where one is due.
  bool looked(const JudgedJoints& joints = JUDGED)
  {
    bool is_other = watch.isDue() && watch.look(joints);
    while (watch.isLooking())
    {
      std::this_thread::yield();
      is_other = watch.isDue() && watch.look(joints);
    }
    return is_other;
  }

  explicit WatchedArm(const std::string& name = "ur5") : arm(shipped(name)) {}
  explicit WatchedArm(const Payload& payload) : arm(configured(shipped("ur5"), payload)) {}

  ArmDescription arm;
  std::array<double, 3> mounted = arm.gravity;
  std::array<double, 6> factors{ 1.0, 1.0, 1.0, 1.0, 1.0, 1.0 };  // of the currents
  std::vector<Parameters> parameters = std::vector<Parameters>(6, shippedParameters());
  std::vector<MotionDriven> drives = std::vector<MotionDriven>(6, MotionDriven(parameters.front()));
  LoadWatch watch{ arm, parameters, { parameters.begin(), parameters.end() } };
  double friction = 1.0;   // times the twins'
  std::size_t silent = 6;  // none
  double end{};            // of the motion [s]
};

TEST(LoadWatch, FindsWhatIsTakenUpAndThatItIsPutDown)
{
  WatchedArm robot;
  EXPECT_TRUE(robot.moved(CARRIED));
  EXPECT_TRUE(robot.watch.isTrying());
  EXPECT_FALSE(robot.watch.isSettled());
  EXPECT_FALSE(robot.moved(CARRIED)) << "it counts already";
  EXPECT_TRUE(robot.watch.isSettled());
  ASSERT_TRUE(robot.watch.assumed().payload);
  EXPECT_NEAR(robot.watch.assumed().payload->mass, CARRIED.mass, 0.5);

  EXPECT_TRUE(robot.moved({}));
  EXPECT_TRUE(robot.watch.isSettled());
  EXPECT_TRUE(robot.watch.assumed().isConfigured());
  EXPECT_EQ(robot.watch.arm().payload.mass, 0.0);
}

/// Rows of before are in the fit, and it lies between two looks.
TEST(LoadWatch, FindsWhatIsTakenUpOrPutDownWhileItMoves)
{
  WatchedArm robot;
  EXPECT_FALSE(robot.moved({}));
  const double taken_up = robot.end;
  EXPECT_FALSE(robot.moved(CARRIED, JUDGED, 15.0)) << "it is not looked for yet";
  EXPECT_TRUE(robot.moved(CARRIED, JUDGED, 6.0));
  EXPECT_FALSE(robot.moved(CARRIED)) << "it counts already";
  ASSERT_TRUE(robot.watch.assumed().payload);
  const IdentifiedPayload& payload = *robot.watch.assumed().payload;
  EXPECT_NEAR(payload.mass, CARRIED.mass, payload.mass_half_width);
  EXPECT_LT(payload.mass_half_width, 0.5);
  EXPECT_NEAR(robot.watch.assumed().since, taken_up, 1.5);

  robot.carry(CARRIED, 20.0);
  EXPECT_TRUE(robot.moved({}, JUDGED, 15.0));
  EXPECT_TRUE(robot.watch.isSettled());
  EXPECT_TRUE(robot.watch.assumed().isConfigured());
  EXPECT_EQ(robot.watch.arm().payload.mass, 0.0);
}

/// One that grows worn, or warm, carries nothing.
TEST(LoadWatch, TakesNoOtherFrictionForAPayloadThatIsTakenUp)
{
  for (const double factor : { 0.7, 1.4 })
  {
    WatchedArm robot;
    EXPECT_FALSE(robot.moved({}));
    robot.friction = factor;
    EXPECT_FALSE(robot.moved({})) << factor;
    EXPECT_EQ(robot.watch.assumed().since, -HUGE_VAL);
  }
}

TEST(LoadWatch, FindsThatTheConfiguredPayloadIsNotCarriedAndThatItIsTakenUp)
{
  WatchedArm robot(CARRIED);
  EXPECT_TRUE(robot.moved({}));
  EXPECT_TRUE(robot.watch.isTrying());
  EXPECT_FALSE(robot.moved({})) << "it counts already";
  EXPECT_TRUE(robot.watch.isSettled());
  ASSERT_TRUE(robot.watch.assumed().payload);
  EXPECT_THAT(robot.watch.assumed().payload->text(), testing::HasSubstr("no payload"));
  EXPECT_EQ(robot.watch.arm().payload.mass, 0.0);

  EXPECT_TRUE(robot.moved(CARRIED));
  EXPECT_TRUE(robot.watch.assumed().isConfigured());
  EXPECT_EQ(robot.watch.arm().payload.mass, CARRIED.mass);
}

TEST(LoadLaw, DoesNotTryAgainThatThereIsNoPayload)
{
  FoundLoad found;
  found.payload.configured.mass = 5.0;
  found.payload.mass = -0.3;
  found.payload.mass_half_width = 0.5;
  found.payload.least_claim = 0.9;
  LoadLaw law;
  EXPECT_TRUE(law.take(found, JUDGED));
  found.payload.configured = {};  // beside what counts now
  found.payload.mass = -2.0;
  for (int look = 0; look < 3; ++look)
  {
    EXPECT_FALSE(law.take(found, JUDGED)) << look;
    EXPECT_FALSE(law.isTrying());
  }
}

TEST(LoadWatch, TakesBackWhatAJointDoesNotFitWith)
{
  JudgedJoints wrong = JUDGED;
  wrong.frictions[ELBOW].is_load_wrong = true;
  for (const double tilt : { 0.0, 9.81 })
  {
    WatchedArm robot;
    robot.mounted = { tilt, 0.0, tilt - 9.81 };
    EXPECT_TRUE(robot.moved(tilt > 0.0 ? Payload() : CARRIED, wrong));
    EXPECT_TRUE(robot.watch.isTrying());
    EXPECT_TRUE(robot.moved(tilt > 0.0 ? Payload() : CARRIED, wrong));
    EXPECT_TRUE(robot.watch.isSettled());
    EXPECT_TRUE(robot.watch.assumed().isConfigured());
    EXPECT_EQ(robot.watch.arm().payload.mass, 0.0);
    EXPECT_EQ(robot.watch.arm().gravity, robot.arm.gravity);
    EXPECT_FALSE(robot.moved(CARRIED)) << "it is not tried again at once";
  }
}

TEST(LoadWatch, StartsAgainAfterAJumpBackOfTheTime)
{
  WatchedArm robot;
  robot.move(7200.0, 5.0, CARRIED);
  robot.watch.reset();
  EXPECT_TRUE(robot.moved(CARRIED));
  ASSERT_TRUE(robot.watch.assumed().payload);
  EXPECT_NEAR(robot.watch.assumed().payload->mass, CARRIED.mass, 0.5);
}

TEST(LoadWatch, TakesNothingThatItLookedForInRowsOfBefore)
{
  WatchedArm robot;
  robot.carry(CARRIED, LONG);
  ASSERT_TRUE(robot.watch.isDue());
  EXPECT_FALSE(robot.watch.look(JUDGED));
  robot.watch.reset();
  EXPECT_FALSE(robot.looked());
  EXPECT_TRUE(robot.watch.frictions().empty());
  EXPECT_TRUE(robot.moved(CARRIED));
}

TEST(LoadWatch, LeavesOutAJointWithoutEfforts)
{
  JudgedJoints five = JUDGED;
  five.measured[ELBOW] = false;
  five.misfits[ELBOW] = { Reason::EFFORT_CONSTANT, "effort is zero" };
  WatchedArm robot;
  robot.silent = ELBOW;
  EXPECT_FALSE(robot.moved({}, five));
  EXPECT_FALSE(robot.watch.frictions().empty());

  robot.watch.reset();
  EXPECT_TRUE(robot.watch.frictions().empty()) << "they are of other rows";
  EXPECT_TRUE(robot.moved(CARRIED, five));
  EXPECT_FALSE(robot.moved(CARRIED, five));
  ASSERT_TRUE(robot.watch.assumed().payload);
  EXPECT_NEAR(robot.watch.assumed().payload->mass, CARRIED.mass, 0.5);
}

/// A wall, a ceiling, a stand that is tilted.
TEST(LoadWatch, FindsHowEveryShippedArmIsMounted)
{
  for (const auto& [name, tilt] :
       { std::pair("ur3", 90.0), std::pair("ur3e", 180.0), std::pair("ur5", 15.0), std::pair("ur5e", 135.0),
         std::pair("ur10", 90.0), std::pair("ur10e", 50.0), std::pair("ur16e", 15.0) })
  {
    SCOPED_TRACE(std::string(name) + ", " + std::to_string(tilt) + " deg");
    WatchedArm robot(name);
    const double across = 9.81 * std::sin(tilt * DEGREE);
    robot.mounted = { 0.6 * across, -0.8 * across, -9.81 * std::cos(tilt * DEGREE) };
    EXPECT_TRUE(robot.moved({}));
    EXPECT_FALSE(robot.watch.assumed().payload);
    const std::optional<IdentifiedMounting>& mounting = robot.watch.assumed().mounting;
    ASSERT_TRUE(mounting);
    EXPECT_NEAR(mounting->tilt(), tilt * DEGREE, std::max(mounting->half_width, DEGREE));
  }
}

TEST(LoadWatch, TakesNothingElseForAMountingOrAPayload)
{
  EXPECT_FALSE(WatchedArm().moved({}));
  WatchedArm loaded;
  EXPECT_TRUE(loaded.moved(CARRIED));
  EXPECT_FALSE(loaded.watch.assumed().mounting);
  for (const std::array<double, 6>& factors : { Angles{ 1.3, 1.3, 1.3, 1.3, 1.3, 1.3 },
                                                { 1.0, -1.0, -1.0, 1.0, 1.0, 1.0 },
                                                { -1.0, -1.0, -1.0, -1.0, -1.0, -1.0 },
                                                { 1.0, -1.0, 1.0, 1.0, 1.0, 1.0 },
                                                { 1.0, 1.5, 1.0, 1.0, 1.0, 1.0 } })
  {
    JudgedJoints judged = JUDGED;
    judged.common.median = factors[0];
    WatchedArm other;
    other.factors = factors;
    other.moved({}, judged);
    EXPECT_FALSE(other.watch.assumed().mounting);
    other.moved({}, judged);
    EXPECT_TRUE(factors[1] == 1.5 || other.watch.assumed().isConfigured())
        << other.watch.assumed().text() << " of a factor " << factors[0];
  }
}
}  // namespace
}  // namespace hjt
