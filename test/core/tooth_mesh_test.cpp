// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <limits>
#include <tuple>

#include "gear/tooth_profile.hpp"
#include "test/core/element_under_test.hpp"
#include "test/core/random_ring.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
/// The mesh once more, tooth by tooth and with trigonometry, from the text of the law.
struct ToothByDefinition
{
  double xi;
  double zeta;
  double clearance;
  double slope;  // of the flank: tangent of its angle
  double depth;
  double energy{};
  double normal_force{};

  ToothByDefinition(const Parameters& parameters, const ToothProfile& profile, const RingShape& shape,
                    const DrivePosition& position, int i)
  {
    const GearParameters& gear = parameters.gear;
    const MeshParameters& mesh = parameters.mesh;
    const double mid_height = gear.rim_thickness + 0.5 * gear.tooth_height_flexspline;
    const Eigen::Vector2d chord =
        shape.points.segment<2>(2 * shape.next(i)) - shape.points.segment<2>(2 * shape.previous(i));
    const double outward = std::atan2(chord.y(), chord.x()) - 0.5 * PI;
    const double x = shape.points[2 * i] + mid_height * std::cos(outward);
    const double y = shape.points[2 * i + 1] + mid_height * std::sin(outward);
    const double axis = position.output_angle + TWO_PI * shape.space[i] / gear.teeth_circular_spline;
    xi = -x * std::sin(axis) + y * std::cos(axis);
    zeta = x * std::cos(axis) + y * std::sin(axis);
    clearance = mesh.flank_clearance +
                (gear.flexspline_inner_radius + mid_height + gear.wave_amplitude - zeta) * std::tan(mesh.flank_angle);
    slope = std::tan(mesh.flank_angle);
    if (mesh.profile != ProfileKind::TRAPEZOID)  // tooth_profile_test.cpp says what they have to be
    {
      clearance = profile.at(zeta).value;
      slope = profile.at(zeta).slope;
    }
    depth = zeta + 0.5 * gear.tooth_height_flexspline - gear.tip_radius_circular_spline;
    const double u = std::clamp(depth / mesh.engagement_depth, 0.0, 1.0);
    const double engaged = u * u * (3.0 - 2.0 * u);
    const double cos_flank = std::cos(mesh.flank_angle);
    for (const double side : { 1.0, -1.0 })
    {
      const double pen = std::max(side * xi - clearance, 0.0);
      const double width = mesh.smoothing;
      const bool ramp = pen < width;
      const double force = ramp ? 0.5 * pen * pen / width : pen - 0.5 * width;
      const double work = ramp ? pen * pen * pen / (6.0 * width) : 0.5 * pen * (pen - width) + width * width / 6.0;
      energy += mesh.stiffness * cos_flank * cos_flank * engaged * work;
      normal_force += side * mesh.stiffness * cos_flank * cos_flank * std::hypot(1.0, slope) * engaged * force;
    }
  }

  bool touches() const { return depth > 0.0 && std::abs(xi) > clearance; }

  /// Distance to the nearest kink of the law, in xi or zeta [m].
  double margin(const MeshParameters& mesh) const
  {
    const double pen = std::abs(xi) - clearance;
    const double at_flank = std::min(std::abs(pen), std::abs(pen - mesh.smoothing));
    const double other_flank = std::min(std::abs(-std::abs(xi) - clearance), std::abs(xi));
    return std::min({ at_flank, other_flank, std::abs(depth), std::abs(depth - mesh.engagement_depth) });
  }
};

/// Smoothing of the contact, profile of the flanks.
class Mesh : public testing::TestWithParam<std::tuple<std::string, std::string>>
{
protected:
  /// A shape no tooth of which stands so near a kink of the law that a difference would straddle it.
  void drawSmooth(RandomRing& ring)
  {
    double margin = 0.0;
    while (margin < 2e-8)
    {
      placed_ = ring.draw(model_);
      margin = 1.0;
      for (int i = 0; i < shape_.teeth(); ++i)
      {
        margin = std::min(margin, tooth(i).margin(parameters_.mesh));
      }
    }
  }

  ToothByDefinition tooth(int i) const { return { parameters_, profile_, shape_, position_, i }; }

  Parameters parameters_ =
      shippedParameters({ "mesh.smoothing=" + std::get<0>(GetParam()), "mesh.profile=" + std::get<1>(GetParam()) });
  ToothProfile profile_{ parameters_.mesh, parameters_.gear };
  RingModel model_{ parameters_ };
  PlacedRing placed_{ RingShape(model_.rest.teeth()), {} };
  RingShape& shape_ = placed_.shape;
  DrivePosition& position_ = placed_.position;
};
INSTANTIATE_TEST_SUITE_P(SmoothingAndProfile, Mesh,
                         testing::Combine(testing::Values("0.0", "20.0e-6"),
                                          testing::Values("trapezoid", "involute", "cycloid", "double_arc")));

TEST_P(Mesh, IsTheGradientOfItsEnergy)
{
  RandomRing ring(20);
  int leading = 0;
  int trailing = 0;
  int entering = 0;
  int ramp = 0;
  int open = 0;
  for (int k = 0; k < 12; ++k)
  {
    SCOPED_TRACE("shape " + std::to_string(k));
    drawSmooth(ring);
    for (int i = 0; i < shape_.teeth(); ++i)
    {
      const ToothByDefinition at = tooth(i);
      open += at.touches() ? 0 : 1;
      leading += at.touches() && at.xi > 0.0 ? 1 : 0;
      trailing += at.touches() && at.xi < 0.0 ? 1 : 0;
      entering += at.touches() && at.depth < parameters_.mesh.engagement_depth ? 1 : 0;
      ramp += at.touches() && std::abs(at.xi) - at.clearance < parameters_.mesh.smoothing ? 1 : 0;
    }
    expectGradientAndTangent(elementOf<ToothMesh>(model_), shape_, position_);
  }
  // The shapes have been everywhere the law has a branch.
  EXPECT_GT(open, 100);
  EXPECT_GT(leading, 50);
  EXPECT_GT(trailing, 50);
  EXPECT_GT(entering, 5);
  EXPECT_EQ(ramp > 5, parameters_.mesh.smoothing > 0.0);
}

TEST_P(Mesh, HasTheEnergyAndTheForcesOfItsLaw)
{
  RandomRing ring(21);
  for (int k = 0; k < 50; ++k)
  {
    placed_ = ring.draw(model_);
    const RingForces forces = elementOf<ToothMesh>(model_).forces(shape_, position_);
    double energy = 0.0;
    for (int i = 0; i < shape_.teeth(); ++i)
    {
      const ToothByDefinition at = tooth(i);
      energy += at.energy;
      // Offsets agree to some 1e-17 m, times the stiffness 5e7 N/m; the smoothstep's slope adds 1e-4 of the force a um.
      ASSERT_NEAR(forces.of<ToothMesh>().flank_force[i], at.normal_force, 1e-8 + 1e-11 * std::abs(at.normal_force))
          << i;
    }
    EXPECT_NEAR(forces.energy, energy, 1e-11 * energy);
  }
}

TEST_P(Mesh, SaysWhereAToothStands)
{
  RandomRing ring(25);
  placed_ = ring.draw(model_);
  for (int i = 0; i < shape_.teeth(); ++i)
  {
    const ToothByDefinition at = tooth(i);
    const ToothPlace place = model_.of<ToothMesh>().place(shape_, position_, i);
    ASSERT_NEAR(place.across, at.xi, 1e-15) << i;
    ASSERT_NEAR(place.depth, at.depth, 1e-15) << i;
    ASSERT_NEAR(place.gap, at.clearance - std::abs(at.xi), 1e-15) << i;
    const double axis = position_.output_angle + TWO_PI * shape_.space[i] / parameters_.gear.teeth_circular_spline;
    const Eigen::Vector2d normal = shape_.chord(i).normal;
    ASSERT_NEAR(place.tilt, std::remainder(std::atan2(normal.y(), normal.x()) - axis, TWO_PI), 1e-12) << i;
  }
}

TEST_P(Mesh, EveryToothHasItsOwnStiffnessAndClearance)
{
  RandomRing ring(22);
  drawSmooth(ring);
  for (int i = 0; i < shape_.teeth(); ++i)
  {
    model_.edit<ToothMesh>().stiffness()[i] *= ring.uniform(0.0, 1.0);
  }
  model_.edit<ToothMesh>().stiffness()[3] = 0.0;  // broken off
  expectGradientAndTangent(elementOf<ToothMesh>(model_), shape_, position_);
  // Enough clearance takes any tooth out of contact.
  model_.edit<ToothMesh>().clearance().setConstant(1e-3);
  const RingForces forces = elementOf<ToothMesh>(model_).forces(shape_, position_);
  EXPECT_EQ(forces.energy, 0.0);
  EXPECT_EQ(allForces(forces).lpNorm<Eigen::Infinity>(), 0.0);
}

TEST_P(Mesh, PairsTeethOutOfContactWithTheNearestSpaceAndNoOthers)
{
  RandomRing ring(23);
  const double space = TWO_PI / parameters_.gear.teeth_circular_spline;
  int changed = 0;
  int kept_in_contact = 0;
  for (int k = 0; k < 50; ++k)
  {
    placed_ = ring.draw(model_);
    // The circular spline turned on under the standing ring, by less than a space or by many.
    position_.output_angle += k % 2 == 0 ? ring.uniform(-0.02, 0.02) : ring.uniform(-PI, PI);
    std::vector<char> touched;
    for (int i = 0; i < shape_.teeth(); ++i)
    {
      touched.push_back(tooth(i).touches() ? 1 : 0);
    }
    const std::vector<int> before = shape_.space;
    model_.of<ToothMesh>().pairNearest(position_, shape_);
    for (int i = 0; i < shape_.teeth(); ++i)
    {
      if (touched[i] != 0)
      {
        ++kept_in_contact;
        ASSERT_EQ(shape_.space[i], before[i]);
        continue;
      }
      changed += shape_.space[i] == before[i] ? 0 : 1;
      ASSERT_GE(shape_.space[i], 0);
      ASSERT_LT(shape_.space[i], parameters_.gear.teeth_circular_spline);
      const ToothByDefinition at = tooth(i);
      // Where a tooth cannot touch however it is tilted, its place at rest is taken for its own.
      const double reach = shape_.points.segment<2>(2 * i).norm() + parameters_.gear.toothMidHeight() +
                           0.5 * parameters_.gear.tooth_height_flexspline;
      const bool can_touch = reach > parameters_.gear.tip_radius_circular_spline;
      ASSERT_LE(std::abs(std::atan2(at.xi, at.zeta)), (can_touch ? 0.5 : 0.75) * space * (1.0 + 1e-9)) << i;
    }
  }
  EXPECT_GT(changed, 1000);
  EXPECT_GT(kept_in_contact, 10);
}

TEST_P(Mesh, SlidingSpeedIsTheChangeOfPlaceAlongTheFlank)
{
  RandomRing ring(24);
  Eigen::VectorXd speeds(2 * shape_.teeth());
  for (Eigen::Index k = 0; k < speeds.size(); ++k)
  {
    speeds[k] = ring.uniform(-1.0, 1.0);
  }
  const double output_speed = 7.0;
  const auto place_after = [&](double time, int i)
  {
    RingShape moved = shape_;
    moved.points += time * speeds;
    moved.updateGeometry();
    DrivePosition position = position_;
    position.output_angle += time * output_speed;
    const ToothByDefinition at(parameters_, profile_, moved, position, i);
    return Eigen::Vector2d(at.xi, at.zeta);
  };
  constexpr double TIME = 1e-8;  // s
  int leading = 0;
  int trailing = 0;
  for (int k = 0; k < 10; ++k)
  {
    placed_ = ring.draw(model_);
    const RingForces forces = elementOf<ToothMesh>(model_).forces(shape_, position_);
    for (const FlankContact& contact : forces.of<ToothMesh>().flanks)
    {
      const int i = contact.tooth;
      const Eigen::Vector2d speed = (place_after(TIME, i) - place_after(-TIME, i)) / (2.0 * TIME);
      const bool on_leading = forces.of<ToothMesh>().flank_force[i] > 0.0;
      (on_leading ? leading : trailing) += 1;
      // The leading flank's normal leans inwards: along it zeta grows as xi falls by tan(beta).
      const double beta = std::atan(tooth(i).slope);
      const double along = std::cos(beta) * speed.y() + (on_leading ? -1.0 : 1.0) * std::sin(beta) * speed.x();
      // Rounding of the place, 4e-18 m, over 2e-8 s; speeds are of order 1 m/s.
      EXPECT_NEAR(model_.of<ToothMesh>().slidingSpeed(shape_, contact, speeds, output_speed), along, 1e-7);
    }
  }
  EXPECT_GT(leading, 5);
  EXPECT_GT(trailing, 5);
}

TEST(MeshGeometry, IsConjugateAtTheMajorAxis)
{
  // The local pitch of the deformed teeth at mid-height and the pitch of the circular spline, both as angles
  // (leading order in w0; thesis geometry): 9.905e-3 against 9.901e-3.
  const Parameters parameters = shippedParameters();
  const RingModel model(parameters);
  const double w0 = parameters.gear.wave_amplitude;
  const DrivePosition position{ 0.0, 0.0, w0 };
  RingShape shape = model.restShape(position);
  pressOnWaveGenerator(model.rest, position, 0.0, shape);
  const ToothProfile profile(parameters.mesh, parameters.gear);
  const ToothByDefinition first(parameters, profile, shape, position, 1);
  const ToothByDefinition second(parameters, profile, shape, position, 2);
  // Teeth move over their spaces by xi a tooth: nearly nothing beside a tooth, where the undeformed ring would have
  // 2 pi (1/200 - 1/202) r_m = 9.9 um.
  EXPECT_LT(std::abs(second.xi - first.xi), 1.0e-6);
  EXPECT_EQ(shape.space[1], 1);
  EXPECT_EQ(shape.space[2], 2);
}

/// A profile and the path of a tooth along it.
struct Flank
{
  explicit Flank(const Parameters& given) : parameters(given) {}

  double fullEngagement() const
  {
    return parameters.gear.flexspline_inner_radius + parameters.gear.toothMidHeight() + parameters.gear.wave_amplitude;
  }

  /// Half clearance with its derivatives at a drop from full engagement.
  HalfClearance at(double drop) const { return profile.at(fullEngagement() - drop); }

  /// What the clearance is wider by than at full engagement [m].
  double widening(double drop) const { return at(drop).value - parameters.mesh.flank_clearance; }

  Parameters parameters;
  ToothProfile profile{ parameters.mesh, parameters.gear };
  EngagementPath path{ parameters.gear };
};

class Profiles : public testing::TestWithParam<std::string>, public Flank
{
protected:
  Profiles() : Flank(shippedParameters({ "mesh.profile=" + GetParam() })) {}
};
INSTANTIATE_TEST_SUITE_P(All, Profiles, testing::Values("trapezoid", "involute", "cycloid", "double_arc"));

TEST_P(Profiles, HasTheFlankClearanceAtFullEngagement)
{
  EXPECT_NEAR(at(0.0).value, parameters.mesh.flank_clearance, 1e-18);
}

TEST_P(Profiles, SlopeAndCurvatureAreItsDerivatives)
{
  constexpr double STEP = 1e-10;  // m
  // From before the entry to beyond full engagement, off the points of the table.
  for (double drop = -0.1e-3; drop < 1.2 * path.entry(); drop += 1.37e-6)
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
  for (double drop = 0.0; drop < path.entry(); drop += 1e-6)
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
    EXPECT_TRUE(std::isfinite(profile.at(zeta).value));
    EXPECT_TRUE(std::isfinite(profile.at(zeta).slope));
  }
  // An angle that is no number must end in forces that are none, not in memory that is not ours.
  EXPECT_FALSE(std::isfinite(profile.at(std::numeric_limits<double>::quiet_NaN()).value));
}

TEST(TrapezoidProfile, IsTheStraightFlank)
{
  const Flank flank(goldenParameters());
  const MeshParameters& mesh = flank.parameters.mesh;
  const double slope = std::tan(mesh.flank_angle);
  for (double zeta = 31e-3; zeta < 33e-3; zeta += 7e-6)
  {
    // To the last bit: it is the profile of the golden numbers.
    const HalfClearance found = flank.profile.at(zeta);
    EXPECT_EQ(found.value, mesh.flank_clearance + (flank.fullEngagement() - zeta) * slope);
    EXPECT_EQ(found.slope, slope);
    EXPECT_EQ(found.curvature, 0.0);
    EXPECT_EQ(found.cosine, std::cos(mesh.flank_angle));
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
  const Flank flank(shippedParameters({ "mesh.profile=involute" }));
  const GearParameters& gear = flank.parameters.gear;
  const double flank_angle = flank.parameters.mesh.flank_angle;
  // The circular spline's tip scrapes along the involute of the tooth: its half thickness by the textbook, thickness
  // s = r (s0 / r0 + 2 (inv alpha0 - inv alpha)), a quarter of a pitch at the reference.
  const double reference = gear.flexspline_inner_radius + gear.toothMidHeight();
  const auto half_thickness = [&](double radius)
  {
    const double angle = std::acos(reference * std::cos(flank_angle) / radius);
    const auto inv = [](double a) { return std::tan(a) - a; };
    return radius * std::sin(std::acos(-1.0) / 400.0 + inv(flank_angle) - inv(angle));
  };
  // Of the tooth at rest, where the circular spline's tip is at full engagement.
  const double full = gear.tip_radius_circular_spline - gear.wave_amplitude;
  // The two involutes are so alike that the contact runs from the tooth's tip to the other's over the first 40 um.
  const double first = 50e-6;
  const double there = flank.widening(first);
  for (double drop = first; drop < gear.wave_amplitude; drop += 10e-6)
  {
    const double expected = half_thickness(full + first) - half_thickness(full + drop);
    EXPECT_NEAR(flank.widening(drop) - there, expected, 0.02e-6) << drop;
  }
  EXPECT_GT(there, 0.0);
  EXPECT_LT(there, first * std::tan(flank_angle + 0.03));
}

TEST(CycloidProfile, FollowsThePathOfTheTooth)
{
  const Flank flank(shippedParameters({ "mesh.profile=cycloid" }));
  for (double drop = 0.0; drop < flank.path.entry(); drop += 1e-6)
  {
    EXPECT_NEAR(flank.widening(drop), flank.path.across(drop), 0.02e-6) << drop;  // the table's points: 2.7 um apart
  }
}

/// Largest gap between a double arc and the path of the tooth, in the first and the second half of the way out [m].
std::array<double, 2> gapToPath(const Flank& flank)
{
  std::array<double, 2> largest{};
  for (double drop = 0.0; drop < flank.path.entry(); drop += 1e-6)
  {
    const double gap = flank.widening(drop) - flank.path.across(drop);
    EXPECT_GT(gap, -0.02e-6) << drop;  // the space is the envelope of the tooth: no interference anywhere
    double& half = largest[drop < 0.5 * flank.path.entry() ? 0 : 1];
    half = std::max(half, gap);
  }
  return largest;
}

TEST(DoubleArcProfile, NeverCrossesThePathAndLeavesLittleGap)
{
  const Parameters parameters = shippedParameters({ "mesh.profile=double_arc" });
  const double straight = parameters.gear.wave_amplitude * (std::tan(parameters.mesh.flank_angle) - 0.256);
  for (const double gap : gapToPath(Flank(parameters)))
  {
    EXPECT_GT(gap, 1e-6);
    EXPECT_LT(gap, 0.5 * straight);  // 17 degrees over the 14.4 of the path's chord
  }
}

TEST(DoubleArcProfile, TouchesThePathWhereTheArcIsAsSteepIfTheRootIsOutOfTheWay)
{
  // With the tangent down to where the circular spline's tip is at full engagement, the concave root cuts nothing.
  const Flank flank(shippedParameters(
      { "mesh.profile=double_arc", "mesh.tangent_angle=0.10471975511965977", "mesh.tangent_length=0.2e-3" }));
  gapToPath(flank);
  for (double drop = 0.3e-3; drop < flank.path.entry(); drop += 5e-6)
  {
    EXPECT_NEAR(flank.widening(drop), flank.path.across(drop), 0.5e-6) << drop;
    EXPECT_NEAR(flank.at(drop).slope, flank.path.slope(drop), 0.01) << drop;
  }
}

TEST(DoubleArcProfile, IsStraightWithATangentSteeperThanThePathOrAsLongAsTheTooth)
{
  for (const std::string tangent : { "mesh.tangent_angle=0.5", "mesh.tangent_length=0.5e-3" })
  {
    const Flank flank(shippedParameters({ "mesh.profile=double_arc", "mesh.tangent_angle=0.3", tangent }));
    for (double drop = 0.0; drop < 0.34e-3; drop += 10e-6)
    {
      EXPECT_NEAR(flank.widening(drop), drop * std::tan(flank.parameters.mesh.tangent_angle), 1e-12);
    }
  }
}
}  // namespace
}  // namespace hjt
