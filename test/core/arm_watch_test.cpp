// SPDX-License-Identifier: BSD-3-Clause
// Which arm rows are of, while they come.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "arm/arm_watch.hpp"
#include "gear/angle.hpp"
#include "test/core/arm_support.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
namespace
{
ArmCandidate candidate(const std::string& name)
{
  ArmCandidate made{ name, shipped(name), {}, 0.0 };
  for (const ArmJoint& joint : made.arm.joints)
  {
    takeInertiaInLoad(made.joints.emplace_back(parseParameters(armJointParameters(joint, HJT_TEST_CONFIG_DIR, ""))));
  }
  return made;
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
  std::vector<MotionDriven> drives(arm.joints.begin(), arm.joints.end());
  std::vector<std::vector<MotionRow>> rows;
  std::vector<JointMotion> motion(drives.size());
  for (int row = 0; row * PERIOD < seconds; ++row)
  {
    const double time = row * PERIOD;
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      const double rate = 0.9 + 0.13 * static_cast<double>(i);
      motion[i] = { BENT[i] + 0.8 * std::sin(rate * time), 0.8 * rate * std::cos(rate * time),
                    -0.8 * rate * rate * std::sin(rate * time) };
    }
    const std::vector<double> torques = torquesOf(dynamics, motion);
    std::vector<MotionRow>& at = rows.emplace_back(motion.size());
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      MotionSample sample;
      sample.time = at[i].time = time;
      sample.position = at[i].position = motion[i].position;
      sample.velocity = at[i].recorded_velocity = motion[i].velocity;
      sample.acceleration = motion[i].acceleration;
      sample.load = torques[i];
      sample.after_gap = row == 0;
      const double more = i == 1 ? std::copysign(friction, sample.velocity) : 0.0;
      at[i].current = size * (drives[i].step(sample).current + more);
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

TEST(RankArms, FrictionOfAJointIsNoOtherArm)
{
  const std::vector<ArmFit> sound = ranked(rowsOfUr5(30.0));
  const std::vector<ArmFit> worn = ranked(rowsOfUr5(30.0, 3.0));
  EXPECT_EQ(sound.front().arm, "ur5");
  EXPECT_EQ(worn.front().arm, "ur5");
  EXPECT_LT(worn.front().cost, worn[1].cost - ArmFit::CONTRADICTED);
}

TEST(BetterArm, ContradictsOrIsNotLookedFor)
{
  constexpr double WORN = 3.0;
  const std::vector<ArmFit> sound = ranked(rowsOfUr5(30.0));
  const std::vector<ArmFit> worn = ranked(rowsOfUr5(30.0, WORN));
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
  constexpr int PATIENCE = 1200;
  for (int k = 0; k < PATIENCE && !watch.look(); ++k)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_TRUE(watch.isSettled());
  EXPECT_EQ(watch.other(), "ur5");
}

TEST(ArmWatch, ForgetsWithItsRowsWhatWasAskedOfThem)
{
  ArmWatch watch(candidates, "ur10");
  const auto finish = [&watch]
  {
    constexpr int PATIENCE = 1200;
    for (int k = 0; k < PATIENCE && !watch.look(); ++k)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  };
  const auto add = [&watch]
  {
    for (const std::vector<MotionRow>& row : rowsOfUr5(31.0))
    {
      watch.add(row);
    }
  };
  add();
  finish();
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
  finish();
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
}  // namespace
}  // namespace hjt
