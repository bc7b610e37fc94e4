// SPDX-License-Identifier: BSD-3-Clause
#include "identification/controller_fit.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gmock/gmock.h>

namespace hjt
{
namespace
{
constexpr double PERIOD = 0.002;           // [s]
constexpr double TORQUE_PER_CURRENT = 10;  // [N.m/A]
constexpr double ANGLE_CURRENT = 2000.0;   // [A/rad]
constexpr double SPEED_CURRENT = 20.0;     // [A.s/rad]
constexpr JointGains USUAL{ 40.0, 100.0, 0.05, 0.0, 0.0 };

/// A joint that swings; its errors are noise, and so is `unexplained`, a share of the current's variance.
std::vector<ControllerRow> recorded(double unexplained)
{
  std::mt19937 random(64);
  std::normal_distribution<double> normal;
  constexpr double ANGLE_ERROR = 1e-4;  // [rad]
  constexpr double SPEED_ERROR = 0.01;  // [rad/s]
  const double of_errors = std::hypot(ANGLE_CURRENT * ANGLE_ERROR, SPEED_CURRENT * SPEED_ERROR);
  std::vector<ControllerRow> rows(10000);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    ControllerRow& row = rows[i];
    const double time = PERIOD * static_cast<double>(i);
    row.angle_error = ANGLE_ERROR * normal(random);
    row.speed_error = SPEED_ERROR * normal(random);
    row.speed = std::sin(time);
    row.rigid_current = 0.5 * std::cos(time);
    row.target_current = row.rigid_current + 0.3 * std::tanh(row.speed / 0.01) + 0.2 * row.speed;
    row.current = row.rigid_current + of_errors * std::sqrt(unexplained / (1.0 - unexplained)) * normal(random);
    if (i >= 2)
    {
      row.current += ANGLE_CURRENT * rows[i - 2].angle_error + SPEED_CURRENT * rows[i - 2].speed_error;
    }
  }
  return rows;
}

ControllerFit fitted(double unexplained)
{
  return fitController(recorded(unexplained), PERIOD, TORQUE_PER_CURRENT, USUAL, 0.0);
}

TEST(ControllerFit, FindsGainsLagAndFrictionThatIsFedForward)
{
  const ControllerFit found = fitted(0.05);
  EXPECT_EQ(found.refusal, "");
  EXPECT_NEAR(found.lag, 2.0 * PERIOD, 1e-9);
  EXPECT_NEAR(found.angle_current, ANGLE_CURRENT, found.angle_half_width);
  EXPECT_NEAR(found.speed_current, SPEED_CURRENT, found.speed_half_width);
  EXPECT_LT(found.angle_half_width, 0.02 * ANGLE_CURRENT);
  EXPECT_LT(found.speed_half_width, 0.02 * SPEED_CURRENT);
  // a / b = k_p + 1 / T_i, of which the integral's time is the usual one's.
  EXPECT_NEAR(found.gains.position, found.angle_current / found.speed_current - 1.0 / USUAL.integral_time, 1e-9);
  EXPECT_NEAR(found.gains.speed, TORQUE_PER_CURRENT * found.speed_current, 1e-9);
  EXPECT_NEAR(found.gains.integral_time, USUAL.integral_time, 1e-12);
  EXPECT_NEAR(found.gains.coulomb, 3.0, 1e-6);
  EXPECT_NEAR(found.gains.viscous, 2.0, 1e-6);
}

TEST(ControllerFit, RefusesWhereTheErrorsExplainLessThanAThird)
{
  const ControllerFit half = fitted(0.5);
  EXPECT_EQ(half.refusal, "");
  EXPECT_NEAR(half.explained, 0.5, 0.02);
  const ControllerFit quarter = fitted(0.75);
  EXPECT_THAT(quarter.refusal, testing::HasSubstr("explain less than a third"));
  EXPECT_EQ(quarter.gains.speed, USUAL.speed);
}
}  // namespace
}  // namespace hjt
