// SPDX-License-Identifier: BSD-3-Clause
// What the friction of an arm's joints has in common: temperature, gain, a hand; no fault of one.
#include <cmath>
#include <cstddef>
#include <vector>

#include <gmock/gmock.h>

#include "tracking/common_friction.hpp"

namespace hjt
{
namespace
{
using testing::DoubleEq;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Lt;

std::vector<MeasuredFriction> jointsWith(const std::vector<double>& ratios)
{
  std::vector<MeasuredFriction> joints;
  for (const double ratio : ratios)
  {
    joints.push_back({ ratio, 25.0, true, [](double temperature) { return 1.25 - 0.01 * temperature; }, false, false });
  }
  return joints;
}

TEST(CommonFriction, WhatAGroupSharesIsNoJointsFault)
{
  const ArmFriction arm = commonFriction(jointsWith({ 1.02, 0.98, 1.0, 1.25, 1.2, 1.22 }), 0.15);
  EXPECT_EQ(arm.median, 1.0);
  ASSERT_EQ(arm.groups.size(), 2U);
  EXPECT_DOUBLE_EQ(arm.groups[0].median, 1.0);
  EXPECT_DOUBLE_EQ(arm.groups[1].median, 1.22);
  EXPECT_THAT(arm.factors, ElementsAre(1.0, 1.0, 1.0, DoubleEq(1.17), DoubleEq(1.17), DoubleEq(1.17)))
      << "5 % may be chance";
  EXPECT_THAT(arm.deviations, Each(0.0)) << "each joint has its group as witness";
  EXPECT_THAT(arm.misfit.clause, IsEmpty());
}

/// The same, each held against its own when it was sound.
std::vector<MeasuredFriction> ownJointsWith(const std::vector<double>& ratios)
{
  std::vector<MeasuredFriction> joints = jointsWith(ratios);
  for (MeasuredFriction& joint : joints)
  {
    joint.temperature_received = false;
    joint.is_to_own = true;
  }
  return joints;
}

TEST(CommonFriction, OfJointsBesideTheirOwnAGroupSharesAllOfIt)
{
  const ArmFriction arm = commonFriction(ownJointsWith({ 1.04, 1.06, 1.09, 1.18, 1.12, 1.13 }), 0.15);
  EXPECT_THAT(arm.factors, ElementsAre(DoubleEq(1.04), DoubleEq(1.06), DoubleEq(1.06), DoubleEq(1.13), DoubleEq(1.12),
                                       DoubleEq(1.13)))
      << "and no joint has too little because the others have more";
  EXPECT_THAT(arm.deviations, Each(0.0));
  const ArmFriction warm = commonFriction(ownJointsWith({ 0.9, 0.92, 1.0, 1.0, 1.0, 1.0 }), 0.15);
  EXPECT_THAT(warm.factors, ElementsAre(0.92, 0.92, 0.92, 1.0, 1.0, 1.0));
  EXPECT_THAT(warm.deviations, Each(Lt(NO_WITNESS))) << "sound joints differ by as much";
  const ArmFriction scattered = commonFriction(ownJointsWith({ 1.0, 1.0, 1.0, 0.67, 0.77, 0.94 }), 0.15);
  EXPECT_DOUBLE_EQ(scattered.factors[5], 0.77);
  EXPECT_GT(scattered.deviations[5], NO_WITNESS) << "two that differ so much say little of the third";
  std::vector<MeasuredFriction> mixed = ownJointsWith({ 1.0, 1.0, 1.0, 1.0, 1.0, 1.0 });
  mixed[0].is_to_own = false;
  EXPECT_THAT(commonFriction(mixed, 0.15).deviations, ElementsAre(0.0, 0.05, 0.05, 0.0, 0.0, 0.0))
      << "a joint held against its type witnesses less of two held against their own";
}

TEST(CommonFriction, OneJointThatRubsIsNoTemperature)
{
  for (std::size_t i = 0; i < 6; ++i)
  {
    std::vector<double> ratios{ 1.05, 1.02, 1.0, 1.09, 1.0, 1.06 };
    ratios[i] *= 1.25;
    const ArmFriction arm = commonFriction(ownJointsWith(ratios), 0.15);
    EXPECT_FALSE(arm.temperature.has_value()) << i;
    EXPECT_GT(ratios[i] / arm.factors[i], 1.14) << i;
    for (std::size_t other = 0; other < 6; ++other)
    {
      EXPECT_TRUE(other == i || std::abs(ratios[other] / arm.factors[other] - 1.0) < 0.08) << i << ' ' << other;
    }
  }
}

TEST(CommonFriction, CurrentsAgainstTheMotionAreOfTheOppositeSign)
{
  std::vector<MeasuredFriction> joints = jointsWith({ 1.0, 1.0, 1.0, 1.0, 1.0, 1.0 });
  for (std::size_t i : { 0, 2 })
  {
    joints[i].is_below_faults = joints[i].is_none = joints[i].is_against = true;
    EXPECT_EQ(commonFriction(joints, 0.15).misfit.reason, i == 0 ? Reason::SOUND : Reason::EFFORT_NOT_CURRENT);
  }
}

TEST(CommonFriction, OneFaultyJointMovesNoGroup)
{
  const ArmFriction arm = commonFriction(jointsWith({ 1.0, 1.6, 1.0, 1.0, 1.0, 1.0 }), 0.15);
  EXPECT_THAT(arm.factors, Each(1.0));
  const ArmFriction apart = commonFriction(jointsWith({ 1.0, 1.6, 2.4, 1.0, 1.0, 1.0 }), 0.15);
  EXPECT_FALSE(apart.groups[0].is_known) << "no two agree";
  EXPECT_EQ(apart.deviations[1], UNWITNESSED);
  EXPECT_EQ(apart.factors[1], 1.0);
}

TEST(CommonFriction, SeveralJointsWithoutFrictionAreNoArmByItself)
{
  std::vector<MeasuredFriction> joints = jointsWith({ 1.0, 1.0, 1.0, 1.0, 1.0, 1.0 });
  joints[0].is_below_faults = true;
  EXPECT_THAT(commonFriction(joints, 0.15).misfit.clause, IsEmpty()) << "one alone may have another gain";
  joints[2].is_below_faults = true;
  EXPECT_EQ(commonFriction(joints, 0.15).misfit.reason, Reason::LESS_THAN_FAULTS);
  EXPECT_THAT(commonFriction(joints, 0.15).misfit.clause, HasSubstr("led by hand"));
  joints[0].is_none = joints[2].is_none = true;
  EXPECT_EQ(commonFriction(joints, 0.15).misfit.reason, Reason::NO_FRICTION);
  EXPECT_THAT(commonFriction(joints, 0.15).misfit.clause, HasSubstr("modelled or commanded torque"));
}

TEST(CommonFriction, TooLittleBesideFarTooMuchIsAnotherOrder)
{
  std::vector<MeasuredFriction> joints = jointsWith({ 1.0, 1.0, 1.0, 1.0, 1.0, 1.9 });
  joints[0].ratio.reset();
  joints[0].is_below_faults = true;
  EXPECT_FALSE(commonFriction(joints, 0.15).misfit.exists()) << "a fault of its own";
  joints[5].ratio = 3.4;
  EXPECT_EQ(commonFriction(joints, 0.15).misfit.reason, Reason::LESS_THAN_FAULTS);
  EXPECT_THAT(commonFriction(joints, 0.15).misfit.clause, HasSubstr("another order"));
  for (MeasuredFriction& joint : joints)
  {
    joint.ratio = 2.3;
  }
  joints[0].ratio.reset();
  EXPECT_FALSE(commonFriction(joints, 0.15).misfit.exists()) << "the whole arm has more";
}

TEST(CommonFriction, JointsThatFitNoLoadLeaveNoneJudged)
{
  std::vector<MeasuredFriction> joints = jointsWith({ 1.0, 1.0, 3.4, 1.0, 1.0, 1.0 });
  joints[0].is_load_wrong = true;
  EXPECT_FALSE(commonFriction(joints, 0.15).misfit.exists()) << "one may be its own fault";
  joints[1].is_load_wrong = true;
  const Misfit misfit = commonFriction(joints, 0.15).misfit;
  EXPECT_EQ(misfit.reason, Reason::LOAD_WRONG);
  EXPECT_THAT(misfit.clause, testing::HasSubstr("another arm"));
  joints[1] = joints[2];
  joints[1].is_below_faults = true;
  EXPECT_EQ(commonFriction(joints, 0.15).misfit.reason, Reason::LOAD_WRONG)
      << "nor is a joint judged beside two that show what no drive does";
}
}  // namespace
}  // namespace hjt
