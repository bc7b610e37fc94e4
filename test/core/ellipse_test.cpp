// SPDX-License-Identifier: BSD-3-Clause
#include "gear/ellipse.hpp"

#include <cmath>
#include <utility>

#include "gear/angle.hpp"
#include "test/support/seeded_random.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
/// Eccentric angle of the closest point: the best of a fine scan, then bisection of the slope of the distance [rad].
double closestByScan(double a, double b, double x, double y)
{
  constexpr int SAMPLES = 2000;
  const auto distance = [&](double t) { return std::hypot(a * std::cos(t) - x, b * std::sin(t) - y); };
  const auto slope = [&](double t)
  { return -(a * std::cos(t) - x) * a * std::sin(t) + (b * std::sin(t) - y) * b * std::cos(t); };
  double best = 0.0;
  for (int i = 1; i < SAMPLES; ++i)
  {
    const double t = TWO_PI * i / SAMPLES;
    best = distance(t) < distance(best) ? t : best;
  }
  double low = best - TWO_PI / SAMPLES;
  double high = best + TWO_PI / SAMPLES;
  for (int i = 0; i < 60; ++i)
  {
    const double middle = 0.5 * (low + high);
    (slope(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void expectFoot(double a, double b, double x, double y, double angle_tolerance)
{
  const EllipseFoot foot = closestPoint(a, b, x, y);
  const double t = closestByScan(a, b, x, y);
  const double nx = b * std::cos(t);
  const double ny = a * std::sin(t);
  const double size = std::hypot(nx, ny);
  EXPECT_NEAR(std::hypot(foot.normal_x, foot.normal_y), 1.0, 1e-14);
  EXPECT_NEAR(foot.normal_x, nx / size, angle_tolerance);
  EXPECT_NEAR(foot.normal_y, ny / size, angle_tolerance);
  EXPECT_NEAR(foot.curvature, a * b / (size * size * size), 10.0 * angle_tolerance * foot.curvature);
  const double distance = std::hypot(a * std::cos(t) - x, b * std::sin(t) - y);
  const bool inside = x * x / (a * a) + y * y / (b * b) < 1.0;
  // To second order in the error of the angle, and rounding of the coordinates.
  EXPECT_NEAR(foot.depth, inside ? distance : -distance, a * angle_tolerance * angle_tolerance + 1e-15 * a);
}

/// Semi-axes of the shipped wave generator [m].
std::pair<double, double> shippedAxes()
{
  const GearParameters gear = shippedParameters().gear;
  return { gear.flexspline_inner_radius + gear.wave_amplitude, gear.flexspline_inner_radius - gear.wave_amplitude };
}

TEST(ClosestPointOfEllipse, AgreesWithBruteForceOnTheWaveGenerator)
{
  SeededRandom random(31);
  const auto [a, b] = shippedAxes();
  for (int k = 0; k < 400; ++k)
  {
    // Up to half a millimetre inside and outside.
    const double depth = (k % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, random.uniform(-8.0, -3.3));
    const double t = random.uniform(-PI, PI);
    // The last Newton step is below 1e-8 rad and leaves 0.02 (1e-8)^2: rounding remains, of scan and foot.
    expectFoot(a, b, (a - depth) * std::cos(t), (b - depth) * std::sin(t), 1e-13);
  }
}

TEST(ClosestPointNearEllipse, IsTheClosestPoint)
{
  SeededRandom random(33);
  const auto [a, b] = shippedAxes();
  for (int k = 0; k < 4000; ++k)
  {
    const double q = (k % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, random.uniform(-9.0, std::log10(0.039)));
    const double t = random.uniform(-PI, PI);
    const double x = std::sqrt(1.0 + q) * a * std::cos(t);
    const double y = std::sqrt(1.0 + q) * b * std::sin(t);
    ASSERT_TRUE(isNear(a, b, x, y)) << q << " " << t;
    const EllipseFoot near = closestPointNear(a, b, x, y);
    const EllipseFoot exact = closestPoint(a, b, x, y);
    // The start is off by the relative depth times the squared eccentricity, 0.046; a Newton step squares that, times
    // 0.02. The length of the unit vector is off by the first term that its series leaves out.
    const double start = 0.5 * std::abs(q) * 0.05;
    const double angle_error = 0.02 * start * start + 1e-15;
    const double length_error = 0.28 * std::pow(q, 4.0) + 1e-15;
    ASSERT_NEAR(near.normal_x, exact.normal_x, angle_error) << q << " " << t;
    ASSERT_NEAR(near.normal_y, exact.normal_y, angle_error) << q << " " << t;
    ASSERT_NEAR(near.depth, exact.depth, a * length_error) << q << " " << t;
    ASSERT_NEAR(near.curvature, exact.curvature, exact.curvature * (4.0 * length_error + angle_error)) << q << " " << t;
  }
}

TEST(ClosestPointNearEllipse, EndsWhereItSays)
{
  for (int k = 0; k < 16; ++k)
  {
    const double t = TWO_PI * k / 16.0;
    const auto near = [&](double q) {
      return isNear(31e-3, 30e-3, std::sqrt(1.0 + q) * 31e-3 * std::cos(t), std::sqrt(1.0 + q) * 30e-3 * std::sin(t));
    };
    EXPECT_TRUE(near(0.0399) && near(-0.0399)) << t;
    EXPECT_FALSE(near(0.0401) || near(-0.0401)) << t;
  }
  EXPECT_FALSE(isNear(31e-3, 30e-3, std::nan(""), 0.0));
}

TEST(ClosestPointOfEllipse, IsExactOnTheAxes)
{
  for (const double side : { 1.0, -1.0 })
  {
    const EllipseFoot major = closestPoint(31e-3, 30e-3, side * 30.9e-3, 0.0);
    EXPECT_EQ(major.normal_x, side);
    EXPECT_EQ(major.normal_y, 0.0);
    EXPECT_NEAR(major.depth, 0.1e-3, 1e-17);
    EXPECT_NEAR(major.curvature, 31e-3 / (30e-3 * 30e-3), 1e-12);
    const EllipseFoot minor = closestPoint(31e-3, 30e-3, 0.0, side * 30.1e-3);
    EXPECT_EQ(minor.normal_x, 0.0);
    EXPECT_EQ(minor.normal_y, side);
    EXPECT_NEAR(minor.depth, -0.1e-3, 1e-17);
    EXPECT_NEAR(minor.curvature, 30e-3 / (31e-3 * 31e-3), 1e-12);
  }
}

TEST(ClosestPointOfEllipse, OfACircleIsRadial)
{
  for (const double radius : { 0.1, 0.9, 1.0, 1.5, 40.0 })
  {
    const EllipseFoot foot = closestPoint(1.0, 1.0, radius * 0.6, radius * 0.8);
    EXPECT_NEAR(foot.normal_x, 0.6, 1e-15);
    EXPECT_NEAR(foot.normal_y, 0.8, 1e-15);
    EXPECT_NEAR(foot.depth, 1.0 - radius, 1e-15 * (1.0 + radius));
    EXPECT_NEAR(foot.curvature, 1.0, 1e-15);
  }
}

TEST(ClosestPointOfEllipse, HoldsForASlimEllipseToo)
{
  // Semi-axes 2 : 1, far from any wave generator; the distances stay below the smallest radius of curvature, b^2/a.
  for (int k = 0; k < 100; ++k)
  {
    const double t = TWO_PI * k / 100 + 0.01;
    const double depth = k % 2 == 0 ? 0.05 : -0.2;
    const double nx = std::cos(t);
    const double ny = 2.0 * std::sin(t);
    const double size = std::hypot(nx, ny);
    expectFoot(2.0, 1.0, 2.0 * std::cos(t) - depth * nx / size, std::sin(t) - depth * ny / size, 2e-8);
  }
}

TEST(ClosestPointOfEllipse, StaysFiniteFarAway)
{
  SeededRandom random(32);
  for (int k = 0; k < 2000; ++k)
  {
    const double t = random.uniform(-PI, PI);
    const double radius = std::pow(10.0, random.uniform(-12.0, 6.0));
    const EllipseFoot foot = closestPoint(31e-3, 30.3e-3, radius * std::cos(t), radius * std::sin(t));
    ASSERT_TRUE(std::isfinite(foot.depth) && std::isfinite(foot.curvature)) << radius << " " << t;
    ASSERT_NEAR(std::hypot(foot.normal_x, foot.normal_y), 1.0, 1e-12) << radius << " " << t;
    if (radius > 31e-3)
    {
      // Outside, whichever point is taken for the foot: not closer than the major, not farther than the minor axis.
      ASSERT_NEAR(-foot.depth, radius - 30.65e-3, 0.351e-3 + 1e-12 * radius) << radius << " " << t;
    }
  }
}
}  // namespace
}  // namespace hjt
