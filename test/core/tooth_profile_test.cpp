// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "gear/tooth_profile.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
double fullEngagement(const GearParameters& gear)
{
  return gear.flexspline_inner_radius + gear.toothMidHeight() + gear.wave_amplitude;
}

class Profiles : public testing::TestWithParam<std::string>
{
protected:
  /// Half clearance with its derivatives at a drop from full engagement.
  HalfClearance at(double drop) const { return profile_.at(fullEngagement(parameters_.gear) - drop); }

  Parameters parameters_ = shippedParameters({ "mesh.profile=" + GetParam() });
  ToothProfile profile_{ parameters_.mesh, parameters_.gear };
  EngagementPath path_{ parameters_.gear };
};
INSTANTIATE_TEST_SUITE_P(All, Profiles, testing::Values("trapezoid", "involute", "cycloid", "double_arc"));

TEST_P(Profiles, HasTheFlankClearanceAtFullEngagement)
{
  EXPECT_NEAR(at(0.0).value, parameters_.mesh.flank_clearance, 1e-18);
}

TEST_P(Profiles, SlopeAndCurvatureAreItsDerivatives)
{
  constexpr double STEP = 1e-10;  // m
  // From before the entry to beyond full engagement, off the points of the table.
  for (double drop = -0.1e-3; drop < 1.2 * path_.entry(); drop += 1.37e-6)
  {
    const HalfClearance flank = at(drop);
    EXPECT_NEAR(flank.slope, (at(drop + STEP).value - at(drop - STEP).value) / (2.0 * STEP), 1e-7) << drop;
    // At a corner of the law the curvature changes by 1e5 1/m over an interval of 2.7 um: by 4 over the step.
    EXPECT_NEAR(flank.curvature, (at(drop - STEP).slope - at(drop + STEP).slope) / (2.0 * STEP), 5.0) << drop;
    EXPECT_NEAR(flank.cosine, 1.0 / std::hypot(1.0, flank.slope), 1e-15) << drop;
  }
}

TEST_P(Profiles, WidensFromFullEngagementToEntry)
{
  for (double drop = 0.0; drop < path_.entry(); drop += 1e-6)
  {
    // A spline through a corner swings by a few percent of the corner.
    EXPECT_GT(at(drop).slope, -0.01) << drop;
    EXPECT_LT(at(drop).slope, 0.5) << drop;
  }
}

TEST_P(Profiles, IsFiniteEverywhere)
{
  for (const double zeta : { -1.0, 0.0, 0.03, 0.04, 1.0 })
  {
    EXPECT_TRUE(std::isfinite(profile_.at(zeta).value));
    EXPECT_TRUE(std::isfinite(profile_.at(zeta).slope));
  }
  // An angle that is no number must end in forces that are none, not in memory that is not ours.
  EXPECT_FALSE(std::isfinite(profile_.at(std::numeric_limits<double>::quiet_NaN()).value));
}

TEST(TrapezoidProfile, IsTheStraightFlank)
{
  const Parameters parameters = goldenParameters();
  const ToothProfile profile(parameters.mesh, parameters.gear);
  const double slope = std::tan(parameters.mesh.flank_angle);
  for (double zeta = 31e-3; zeta < 33e-3; zeta += 7e-6)
  {
    // To the last bit: it is the profile of the golden numbers.
    EXPECT_EQ(profile.at(zeta).value,
              parameters.mesh.flank_clearance + (fullEngagement(parameters.gear) - zeta) * slope);
    EXPECT_EQ(profile.at(zeta).slope, slope);
    EXPECT_EQ(profile.at(zeta).curvature, 0.0);
    EXPECT_EQ(profile.at(zeta).cosine, std::cos(parameters.mesh.flank_angle));
  }
}

TEST(EngagementPath, IsTheMotionOfTheIdealRing)
{
  const GearParameters gear = shippedParameters().gear;
  const EngagementPath path(gear);
  const double radius = gear.flexspline_inner_radius + gear.toothMidHeight();
  // Radially w0 cos 2 psi; around: half of that by the ring, and the tooth lags its space by the pitches' difference.
  for (double psi = 0.0; psi < 0.78; psi += 0.01)
  {
    const double drop = gear.wave_amplitude * (1.0 - std::cos(2.0 * psi));
    const double pitches = radius * psi * (1.0 - 200.0 / 202.0);
    const double around =
        0.5 * gear.wave_amplitude * (1.0 - 3.0 * gear.toothMidHeight() / gear.flexspline_inner_radius);
    // The measured gear is conjugate at its major axis but for 0.06 %: pitches 9.905e-3 against 9.901e-3 rad.
    EXPECT_NEAR(path.across(drop), pitches - around * std::sin(2.0 * psi), 6e-4 * pitches + 1e-12);
  }
  EXPECT_NEAR(path.entry(), 0.35e-3, 1e-12);
  const double step = 1e-9;
  for (double drop = 1e-5; drop < path.entry(); drop += 1e-5)
  {
    EXPECT_NEAR(path.slope(drop), (path.across(drop + step) - path.across(drop - step)) / (2.0 * step), 1e-6);
  }
}

TEST(InvoluteProfile, TouchesAtTheTipOfTheCircularSpline)
{
  const Parameters parameters = shippedParameters({ "mesh.profile=involute" });
  const GearParameters& gear = parameters.gear;
  const ToothProfile profile(parameters.mesh, gear);
  // The circular spline's tip scrapes along the involute of the tooth: its half thickness by the textbook, thickness
  // s = r (s0 / r0 + 2 (inv alpha0 - inv alpha)), a quarter of a pitch at the reference.
  const double reference = gear.flexspline_inner_radius + gear.toothMidHeight();
  const auto half_thickness = [&](double radius)
  {
    const double angle = std::acos(reference * std::cos(parameters.mesh.flank_angle) / radius);
    const auto inv = [](double a) { return std::tan(a) - a; };
    return radius * std::sin(std::acos(-1.0) / 400.0 + inv(parameters.mesh.flank_angle) - inv(angle));
  };
  // Of the tooth at rest, where the circular spline's tip is at full engagement.
  const double full = gear.tip_radius_circular_spline - gear.wave_amplitude;
  // The two involutes are so alike that the contact runs from the tooth's tip to the other's over the first 40 um.
  const double first = 50e-6;
  const double there = profile.at(fullEngagement(gear) - first).value;
  for (double drop = first; drop < gear.wave_amplitude; drop += 10e-6)
  {
    const double expected = half_thickness(full + first) - half_thickness(full + drop);
    EXPECT_NEAR(profile.at(fullEngagement(gear) - drop).value - there, expected, 0.02e-6) << drop;
  }
  EXPECT_GT(there, parameters.mesh.flank_clearance);
  EXPECT_LT(there - parameters.mesh.flank_clearance, first * std::tan(parameters.mesh.flank_angle + 0.03));
}

TEST(CycloidProfile, FollowsThePathOfTheTooth)
{
  const Parameters parameters = shippedParameters({ "mesh.profile=cycloid" });
  const ToothProfile profile(parameters.mesh, parameters.gear);
  const EngagementPath path(parameters.gear);
  for (double drop = 0.0; drop < path.entry(); drop += 1e-6)
  {
    const double gap =
        profile.at(fullEngagement(parameters.gear) - drop).value - parameters.mesh.flank_clearance - path.across(drop);
    EXPECT_NEAR(gap, 0.0, 0.02e-6) << drop;  // the table's points stand 2.7 um apart
  }
}

/// Largest gap between a double arc and the path of the tooth, in the first and the second half of the way out [m].
std::array<double, 2> gapToPath(const Parameters& parameters)
{
  const ToothProfile profile(parameters.mesh, parameters.gear);
  const EngagementPath path(parameters.gear);
  std::array<double, 2> largest{};
  for (double drop = 0.0; drop < path.entry(); drop += 1e-6)
  {
    const double gap =
        profile.at(fullEngagement(parameters.gear) - drop).value - parameters.mesh.flank_clearance - path.across(drop);
    EXPECT_GT(gap, -0.02e-6) << drop;  // the space is the envelope of the tooth: no interference anywhere
    double& half = largest[drop < 0.5 * path.entry() ? 0 : 1];
    half = std::max(half, gap);
  }
  return largest;
}

TEST(DoubleArcProfile, NeverCrossesThePathAndLeavesLittleGap)
{
  const Parameters parameters = shippedParameters({ "mesh.profile=double_arc" });
  const double straight = parameters.gear.wave_amplitude * (std::tan(parameters.mesh.flank_angle) - 0.256);
  for (const double gap : gapToPath(parameters))
  {
    EXPECT_GT(gap, 1e-6);
    EXPECT_LT(gap, 0.5 * straight);  // 17 degrees over the 14.4 of the path's chord
  }
}

TEST(DoubleArcProfile, TouchesThePathWhereTheArcIsAsSteepIfTheRootIsOutOfTheWay)
{
  // With the tangent down to where the circular spline's tip is at full engagement, the concave root cuts nothing.
  const Parameters parameters = shippedParameters(
      { "mesh.profile=double_arc", "mesh.tangent_angle=0.10471975511965977", "mesh.tangent_length=0.2e-3" });
  const ToothProfile profile(parameters.mesh, parameters.gear);
  const EngagementPath path(parameters.gear);
  gapToPath(parameters);
  for (double drop = 0.3e-3; drop < path.entry(); drop += 5e-6)
  {
    const HalfClearance flank = profile.at(fullEngagement(parameters.gear) - drop);
    EXPECT_NEAR(flank.value - parameters.mesh.flank_clearance, path.across(drop), 0.5e-6) << drop;
    EXPECT_NEAR(flank.slope, path.slope(drop), 0.01) << drop;
  }
}

TEST(DoubleArcProfile, IsStraightWithATangentSteeperThanThePathOrAsLongAsTheTooth)
{
  for (const std::string tangent : { "mesh.tangent_angle=0.5", "mesh.tangent_length=0.5e-3" })
  {
    const Parameters parameters = shippedParameters({ "mesh.profile=double_arc", "mesh.tangent_angle=0.3", tangent });
    const ToothProfile profile(parameters.mesh, parameters.gear);
    const double slope = std::tan(parameters.mesh.tangent_angle);
    for (double drop = 0.0; drop < 0.34e-3; drop += 10e-6)
    {
      EXPECT_NEAR(profile.at(fullEngagement(parameters.gear) - drop).value,
                  parameters.mesh.flank_clearance + drop * slope, 1e-12);
    }
  }
}
}  // namespace
}  // namespace hjt
