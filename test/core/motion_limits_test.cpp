// SPDX-License-Identifier: BSD-3-Clause
#include "arm/set_points.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "arm/arm_controller.hpp"
#include "gear/ratio.hpp"
#include "test/core/rods.hpp"

namespace hjt
{
namespace
{
using testing::HasSubstr;

/// Two rods that turn about the vertical, so that nothing but inertia counts; the first joint goes that far in a tenth
/// of a second, at an acceleration of 600 times the way at both ends.
std::string errorsOf(const ArmDescription& arm, double way, const Payload& payload = {})
{
  MotionLimits limits(arm, { drive(), drive() });
  limits.setPayload(payload);
  return limits.errors({ { 0.0, { {}, {} } }, { 0.1, { { way, 0.0, 0.0 }, {} } } });
}

TEST(MotionLimits, HoldOfLinksAndOfTheMotor)
{
  ArmDescription arm = rods("0 0 1", 2);
  ArmDynamics dynamics(arm);
  std::vector<double> torques(2);
  dynamics.torques({ { 0.0, 0.0, 1.0 }, {} }, torques);
  const double inertia = torques[0];
  const double motor_limit = nominalRatio(drive().gear) * drive().motor.torque_limit;
  const double most = motor_limit / (inertia + ArmController::motorInertia(drive())) / 600.0;
  EXPECT_EQ(errorsOf(arm, 0.99 * most), "");
  EXPECT_THAT(errorsOf(arm, 1.01 * most), HasSubstr("joint_0 would need"));
  EXPECT_THAT(errorsOf(arm, 1.01 * most), HasSubstr("N.m of its motor before 0.1 s, at"));
  EXPECT_THAT(errorsOf(arm, -1.01 * most), HasSubstr("N.m of its motor"));
  // What the joint may bear is less here.
  arm.joints[0].torque_limit = 0.5 * inertia * most * 600.0;
  EXPECT_EQ(errorsOf(arm, 0.49 * most), "");
  EXPECT_THAT(errorsOf(arm, 0.51 * most), HasSubstr("its limit is"));
  // A payload needs torque too.
  EXPECT_THAT(errorsOf(arm, 0.49 * most, { 5.0, { 0.1, 0.0, 0.0 } }), HasSubstr("its limit is"));
}
}  // namespace
}  // namespace hjt
