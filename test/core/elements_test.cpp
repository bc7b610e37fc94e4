// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <utility>

#include "elements/contact_laws.hpp"
#include "elements/ring_friction.hpp"
#include "test/core/element_under_test.hpp"
#include "test/core/random_ring.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
/// Nearer to the depth at which Hertz' contact opens, its curvature shows in a difference [m].
constexpr double HERTZ_KINK = 1.5e-7;

TEST(RimTension, HasTheEnergyOfItsSprings)
{
  const Parameters parameters = goldenParameters();
  const RingModel model(parameters);
  RandomRing ring(2);
  const auto [shape, position] = ring.draw(model);
  const double rest = (model.rest.points().segment<2>(2) - model.rest.points().head<2>()).norm();
  double energy = 0.0;
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const double length = (shape.points.segment<2>(2 * shape.next(i)) - shape.points.segment<2>(2 * i)).norm();
    energy += 0.5 * parameters.ring.tension_stiffness * (length - rest) * (length - rest);
    EXPECT_NEAR(model.of<RimTension>().tension(shape, i), parameters.ring.tension_stiffness * (length - rest), 1e-6);
  }
  EXPECT_NEAR(elementOf<RimTension>(model).forces(shape, position).energy, energy, 1e-12 * energy);
}

TEST(RimTension, ACutSegmentPullsNoLonger)
{
  RingModel model(goldenParameters());
  model.edit<RimTension>().stiffness()[7] = 0.0;
  RandomRing ring(3);
  const auto [shape, position] = ring.draw(model);
  expectGradientAndTangent(elementOf<RimTension>(model), shape, position);
  EXPECT_EQ(model.of<RimTension>().tension(shape, 7), 0.0);
}

/// Small differences of lengths and depths show the speeds in the dashpots. Half a ring takes what the whole one does.
TEST(RingDamping, TakesThePowerOfItsDashpots)
{
  const Parameters parameters =
      goldenParameters({ "ring.tension_damping=3.0", "ring.tooth_damping=0.5", "contact.damping=7.0" });
  const RingModel model(parameters);
  RandomRing ring(6);
  const PlacedRing drawn = ring.draw(model);
  const DrivePosition& position = drawn.position;
  RingShape half = drawn.shape;
  const int n = half.teeth();
  half.solved = n / 2;
  half.updateGeometry();
  std::array<Eigen::VectorXd, 2> by_angle{ Eigen::VectorXd(2 * n), Eigen::VectorXd(2 * n) };
  for (Eigen::VectorXd& rates : by_angle)
  {
    std::generate_n(rates.data(), n, [&] { return ring.uniform(-1e-2, 1e-2); });
    rates.tail(n) = -rates.head(n);
  }
  const auto at = [&](const Eigen::Vector2d& angles)
  {
    RingShape shape = half.whole();
    shape.points += angles[0] * by_angle[0] + angles[1] * by_angle[1];
    shape.updateGeometry();
    RingForces forces(n);
    model.forces(
        shape,
        { position.wave_generator_angle + angles[0], position.output_angle + angles[1], position.wave_amplitude },
        forces);
    return std::make_pair(shape.lengths, forces.of<WaveGeneratorContact>());
  };
  const RingDamping damping(parameters.ring, parameters.contact);
  JointFriction by_half(n);
  JointFriction by_whole(n);
  const RingShape whole = half.whole();
  const auto contact = at({ 0.0, 0.0 }).second;
  damping.add(contact, { half, by_angle[0], by_angle[1] }, by_half);
  damping.add(contact, { whole, by_angle[0], by_angle[1] }, by_whole);
  constexpr double STEP = 1e-7;  // s
  for (const Eigen::Vector2d& speeds : { Eigen::Vector2d(1.0, 0.0), { 0.0, 1.0 }, { 1.0, 1.0 } })
  {
    const auto before = at(-STEP * speeds);
    const auto after = at(STEP * speeds);
    const Eigen::VectorXd stretching = (after.first - before.first) / (2.0 * STEP);
    const Eigen::VectorXd deepening = (after.second.depth - before.second.depth) / (2.0 * STEP);
    const double power = 3.0 * stretching.squaredNorm() +
                         0.5 * (speeds[0] * by_angle[0] + speeds[1] * by_angle[1]).squaredNorm() +
                         7.0 * (contact.depth.array() > 0.0).select(deepening.array().square(), 0.0).sum();
    EXPECT_NEAR(speeds.dot(by_half.viscous * speeds), power, DIFFERENCE_TOLERANCE * power);
    EXPECT_NEAR(speeds.dot(by_whole.viscous * speeds), power, DIFFERENCE_TOLERANCE * power);
  }
}

using RimBendingLaws = testing::TestWithParam<std::string>;
INSTANTIATE_TEST_SUITE_P(Both, RimBendingLaws, testing::Values("absolute", "curvature"));

TEST_P(RimBendingLaws, IsTheGradientOfItsEnergy)
{
  RingModel model(goldenParameters({ "ring.bending_law=" + GetParam() }));
  RandomRing ring(4);
  for (int k = 0; k < 4; ++k)
  {
    SCOPED_TRACE("shape " + std::to_string(k));
    const auto [shape, position] = ring.draw(model);
    expectGradientAndTangent(elementOf<RimBending>(model), shape, position);
    // A crack: every tooth its own stiffness, one without any.
    model.edit<RimBending>().stiffness()[10 * k] = k == 0 ? 0.0 : 100.0 * k;
  }
}

TEST_P(RimBendingLaws, HasTheEnergyOfItsLaw)
{
  const Parameters parameters = goldenParameters({ "ring.bending_law=" + GetParam() });
  const RingModel model(parameters);
  RandomRing ring(5);
  const auto [shape, position] = ring.draw(model);
  std::vector<double> turn(shape.teeth());
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const Eigen::Vector2d now = shape.points.segment<2>(2 * shape.next(i)) - shape.points.segment<2>(2 * i);
    const double rest = (i + 0.5) * model.rest.pitchAngle() + 0.5 * PI;
    turn[i] = std::remainder(std::atan2(now.y(), now.x()) - rest, TWO_PI);
  }
  double energy = 0.0;
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const double angle = GetParam() == "absolute" ? turn[i] : turn[i] - turn[shape.previous(i)];
    energy += 0.5 * parameters.ring.bending_stiffness * angle * angle;
  }
  EXPECT_NEAR(elementOf<RimBending>(model).forces(shape, position).energy, energy, 1e-9 * energy);
}

/// What is done to the rim is not done to the race beside it.
TEST(RimBending, LeavesTheRaceAsItIs)
{
  const RingModel bare(goldenParameters({ "ring.bending_stiffness=100.0" }));
  RingModel both(goldenParameters({ "ring.bending_stiffness=400.0", "bearing.race_bending_stiffness=100.0" }));
  RimBending& cracked = both.edit<RimBending>();
  cracked.stiffness().setZero();
  cracked.naturalAngle().setConstant(1e-3);
  RandomRing ring(30);
  const auto [shape, position] = ring.draw(bare);
  const RingForces race = elementOf<RimBending>(both).forces(shape, position);
  const RingForces rim = elementOf<RimBending>(bare).forces(shape, position);
  EXPECT_EQ(race.energy, rim.energy);
  EXPECT_TRUE(race.teeth == rim.teeth);
  cracked.stiffness().setConstant(50.0);
  expectGradientAndTangent(elementOf<RimBending>(both), shape, position);
}

using CupTorsionRanges = testing::TestWithParam<double>;
// Mean rotations [rad] on every slope of the law: the shipped breakpoints lie at 0.4516e-3 and 1.1316e-3 rad.
INSTANTIATE_TEST_SUITE_P(BothSigns, CupTorsionRanges,
                         testing::Values(0.3e-3, -0.3e-3, 0.8e-3, -0.8e-3, 5e-3, -5e-3, 0.3));

TEST_P(CupTorsionRanges, IsTheGradientOfItsEnergy)
{
  const RingModel model(goldenParameters());
  RingShape shape(model.rest.teeth());
  DrivePosition position{ 0.4, 0.1, 0.35e-3 };
  pressOnWaveGenerator(model.rest, position, GetParam(), shape);
  SeededRandom random(8);
  shake(30e-6, random, shape);
  ASSERT_NEAR(model.of<CupTorsion>().meanRotation(shape), GetParam(), 1e-4);
  expectGradientAndTangent(elementOf<CupTorsion>(model), shape, position);
}

TEST(CupTorsion, FollowsItsTableOnBothSides)
{
  const Parameters parameters = goldenParameters();
  const RingModel model(parameters);
  const auto& k = parameters.cup.torsion_stiffness;
  const auto& t = parameters.cup.torsion_breakpoints;
  const double first = t[0] / k[0];
  const double second = first + (t[1] - t[0]) / k[1];
  for (const double sign : { 1.0, -1.0 })
  {
    // Products and sums of a few terms: rounding only.
    EXPECT_NEAR(model.of<CupTorsion>().torque(sign * 0.5 * first), sign * 0.5 * t[0], 1e-12);
    EXPECT_NEAR(model.of<CupTorsion>().torque(sign * first), sign * t[0], 1e-12);
    EXPECT_NEAR(model.of<CupTorsion>().torque(sign * 0.5 * (first + second)), sign * 0.5 * (t[0] + t[1]), 1e-12);
    EXPECT_NEAR(model.of<CupTorsion>().torque(sign * second), sign * t[1], 1e-12);
    EXPECT_NEAR(model.of<CupTorsion>().torque(sign * (second + 1e-3)), sign * (t[1] + 1e-3 * k[2]), 1e-12);
    EXPECT_EQ(model.of<CupTorsion>().stiffness(sign * 0.9 * first), k[0]);
    EXPECT_EQ(model.of<CupTorsion>().stiffness(sign * 1.1 * first), k[1]);
    EXPECT_EQ(model.of<CupTorsion>().stiffness(sign * 1.1 * second), k[2]);
  }
  EXPECT_EQ(model.of<CupTorsion>().torque(0.0), 0.0);
  EXPECT_EQ(model.of<CupTorsion>().storedEnergy(0.0), 0.0);
}

TEST(CupTorsion, StoresTheIntegralOfItsTorque)
{
  const RingModel model(goldenParameters());
  constexpr int STEPS = 3000;
  const double step = 3e-3 / STEPS;
  double energy = 0.0;
  for (int i = 0; i < STEPS; ++i)
  {
    energy += step * model.of<CupTorsion>().torque((i + 0.5) * step);
    // The midpoint rule is exact but in the two steps with a kink: slope change times step^2 / 8 each.
    ASSERT_NEAR(model.of<CupTorsion>().storedEnergy((i + 1) * step), energy, 2 * 19e3 * step * step / 8);
    ASSERT_EQ(model.of<CupTorsion>().storedEnergy(-(i + 1) * step),
              model.of<CupTorsion>().storedEnergy((i + 1) * step));
  }
}

TEST(CupTorsion, AWeakerWallAddsItsComplianceToEverySlope)
{
  const Parameters parameters = goldenParameters();
  RingModel model(parameters);
  model.edit<CupTorsion>().scaleWall(0.5);
  model.edit<CupTorsion>().scaleWall(0.8);
  const CupTorsion& cup = model.of<CupTorsion>();
  const auto& torques = parameters.cup.torsion_breakpoints;
  const std::array<double, 3> at{ 0.5 * torques[0], 0.5 * (torques[0] + torques[1]), 2.0 * torques[1] };
  for (std::size_t i = 0; i < at.size(); ++i)
  {
    const double compliance = 1.0 / parameters.cup.torsion_stiffness[i] + 1.5 / parameters.cup.wall_stiffness;
    EXPECT_NEAR(cup.complianceAtTorque(at[i]) / compliance, 1.0, 1e-12) << "factors multiply: 0.4 of the wall is left";
  }
  RingShape shape(model.rest.teeth());
  const DrivePosition position{ 0.4, 0.1, 0.35e-3 };
  for (const double rotation : { 3e-4, -1.1e-3, 3e-3 })
  {
    pressOnWaveGenerator(model.rest, position, rotation, shape);
    expectGradientAndTangent(elementOf<CupTorsion>(model), shape, position);
  }
}

/// RingModel::tangent asserts it.
TEST(RingForces, AreOfTheShapeTheyWereComputedFor)
{
#ifdef NDEBUG
  GTEST_SKIP() << "a build without assertions notes no shape";
#endif
  const RingModel model(goldenParameters());
  RingShape shape = model.restShape({});
  RingForces forces(shape.teeth());
  model.forces(shape, {}, forces);
  EXPECT_TRUE(forces.areOf(shape));
  shape.points[17] += 1e-12;
  EXPECT_FALSE(forces.areOf(shape));
}

/// An element in the tests that all of them have to pass.
struct Row
{
  const char* name;
  ElementUnderTest (*of)(const RingModel& model);
  bool grounded{ false };  // held by the housing: a rigid turn of the whole machine changes it
  std::vector<std::string> parameters{};
  double kink{ 0.0 };  // no tooth touches or stands off by less [m]
};
const std::vector<Row> ELEMENTS{
  { "tension", elementOf<RimTension> },
  { "absolute_bending", elementOf<RimBending>, true, { "ring.bending_law=absolute" } },
  { "curvature_bending", elementOf<RimBending> },
  { "bending_with_race", elementOf<RimBending>, false, { "bearing.race_bending_stiffness=670.0" } },
  { "contact_on_balls", elementOf<WaveGeneratorContact>, false, { "contact.support=balls" }, HERTZ_KINK },
  { "contact_on_warm_balls",
    elementOf<WaveGeneratorContact>,
    false,
    { "contact.support=balls", "contact.fit=-5.0e-6", "contact.temperature_difference=12.0" },
    HERTZ_KINK },
  { "contact", elementOf<WaveGeneratorContact> },
  { "cup", elementOf<CupTorsion>, true },
  { "mesh", elementOf<ToothMesh> },
};

/// What is common to all elements: laws that have an energy, resist nothing at rest, and know no left and right.
class AnyElement : public testing::TestWithParam<Row>
{
protected:
  ElementUnderTest element() const { return GetParam().of(model_); }

  RingModel model_{ goldenParameters(GetParam().parameters) };
};
INSTANTIATE_TEST_SUITE_P(All, AnyElement, testing::ValuesIn(ELEMENTS),
                         [](const auto& row) { return std::string(row.param.name); });

TEST_P(AnyElement, IsTheGradientOfItsEnergy)
{
  std::vector<std::string> parameters = GetParam().parameters;
  parameters.insert(parameters.end(), { "contact.smoothing=20.0e-6", "mesh.smoothing=20.0e-6" });
  const RingModel model(goldenParameters(parameters));
  RandomRing ring(12);
  for (int k = 0; k < 3;)
  {
    const auto [shape, position] = ring.draw(model);
    if (GetParam().kink > 0.0 &&
        GetParam().of(model).forces(shape, position).of<WaveGeneratorContact>().depth.cwiseAbs().minCoeff() <
            GetParam().kink)
    {
      continue;
    }
    SCOPED_TRACE("shape " + std::to_string(k++));
    expectGradientAndTangent(GetParam().of(model), shape, position);
  }
}

TEST_P(AnyElement, DoesNothingAtRest)
{
  const DrivePosition position;
  const RingForces forces = element().forces(model_.restShape(position), position);
  // Points rounded to some 1e-17 m against the stiffest spring, 5e9 N/m; angles to 1e-16 rad over a pitch, 1 mm.
  EXPECT_LT(allForces(forces).lpNorm<Eigen::Infinity>(), 1e-6);
  EXPECT_LT(forces.energy, 1e-15);
}

TEST_P(AnyElement, MirroredShapeGivesMirroredForces)
{
  RandomRing ring(9);
  for (int k = 0; k < 10; ++k)
  {
    const auto [shape, position] = ring.draw(model_);
    RingShape mirror(shape.teeth());
    mirror.points = mirrored(shape.points);
    mirror.updateGeometry();
    for (int i = 0; i < shape.teeth(); ++i)
    {
      const int spaces = model_.gear.teeth_circular_spline;
      mirror.space[(shape.teeth() - i) % shape.teeth()] = (spaces - shape.space[i]) % spaces;
    }
    const RingForces forces = element().forces(shape, position);
    const RingForces other =
        element().forces(mirror, { -position.wave_generator_angle, -position.output_angle, position.wave_amplitude });
    // Rounding of the coordinates (4e-18 m) against 1e-6 ... 1e-4 m of displacement.
    EXPECT_LT(relativeError(mirrored(forces.teeth), other.teeth), 1e-9);
    EXPECT_NEAR(forces.energy, other.energy, 1e-9 * forces.energy);
    EXPECT_NEAR(forces.wave_generator_torque, -other.wave_generator_torque,
                1e-9 * (std::abs(other.wave_generator_torque) + forces.teeth.lpNorm<1>() * 1e-3));
    EXPECT_NEAR(forces.output_torque, -other.output_torque, 1e-9 * (1.0 + std::abs(other.output_torque)));
  }
}

TEST_P(AnyElement, ChangesUnderARigidTurnOnlyIfItIsHeldByTheHousing)
{
  const bool grounded = GetParam().grounded;
  RandomRing ring(10);
  for (const double angle : { 1e-3, -0.7, 2.0, PI })
  {
    const auto [shape, position] = ring.draw(model_);
    const RingForces forces = element().forces(shape, position);
    RingShape moved = shape;
    moved.points = turned(shape.points, angle);
    moved.updateGeometry();
    const RingForces after = element().forces(
        moved, { position.wave_generator_angle + angle, position.output_angle + angle, position.wave_amplitude });
    if (grounded)
    {
      EXPECT_GT(relativeError(turned(forces.teeth, angle), after.teeth), 1e-3) << angle;
      EXPECT_GT(std::abs(after.energy - forces.energy), 1e-3 * forces.energy) << angle;
      continue;
    }
    EXPECT_LT(relativeError(turned(forces.teeth, angle), after.teeth), 1e-9) << angle;
    EXPECT_NEAR(after.energy, forces.energy, 1e-9 * forces.energy) << angle;
    EXPECT_NEAR(after.wave_generator_torque, forces.wave_generator_torque,
                1e-9 * (1.0 + std::abs(forces.wave_generator_torque)));
    EXPECT_NEAR(after.output_torque, forces.output_torque, 1e-9 * (1.0 + std::abs(forces.output_torque)));
    // So no torque is left on the whole: ring, wave generator and circular spline together.
    double torque = forces.wave_generator_torque + forces.output_torque;
    for (int i = 0; i < shape.teeth(); ++i)
    {
      torque += shape.points[2 * i] * forces.teeth[2 * i + 1] - shape.points[2 * i + 1] * forces.teeth[2 * i];
    }
    EXPECT_NEAR(torque, 0.0, 1e-12 * forces.teeth.lpNorm<1>());
  }
}

/// Smoothing of the contacts: the exact law and a ramp as wide as the penetrations, so that all its branches are met.
using WaveGeneratorContactNormal = testing::TestWithParam<std::string>;
INSTANTIATE_TEST_SUITE_P(Smoothing, WaveGeneratorContactNormal, testing::Values("0.0", "20.0e-6"));

TEST_P(WaveGeneratorContactNormal, IsTheGradientOfItsEnergy)
{
  const Parameters parameters = goldenParameters({ "contact.smoothing=" + GetParam() });
  const RingModel model(parameters);
  const ElementUnderTest contact = elementOf<WaveGeneratorContact>(model);
  RandomRing ring(6);
  int open = 0;
  int ramp = 0;
  int full = 0;
  for (int k = 0; k < 12;)
  {
    const auto [shape, position] = ring.draw(model);
    const Eigen::ArrayXd depth = contact.forces(shape, position).of<WaveGeneratorContact>().depth.array();
    // No tooth so near a kink of the law that a difference would straddle it.
    const double width = parameters.contact.smoothing;
    if (std::min(depth.abs().minCoeff(), (depth - width).abs().minCoeff()) < 1e-8)
    {
      continue;
    }
    SCOPED_TRACE("shape " + std::to_string(k++));
    open += static_cast<int>((depth < 0.0).count());
    ramp += static_cast<int>((depth > 0.0 && depth < width).count());
    full += static_cast<int>((depth > std::max(width, 0.0)).count());
    expectGradientAndTangent(contact, shape, position);
  }
  EXPECT_GT(open, 100);
  EXPECT_GT(full, 100);
  EXPECT_EQ(ramp > 100, parameters.contact.smoothing > 0.0);
}

/// Rim and race stand back from each other where they are worn, and where a faulty bearing lets the race down.
TEST_P(WaveGeneratorContactNormal, IsTheGradientOfItsEnergyBehindAGap)
{
  for (const bool sound : { true, false })
  {
    RingModel model(goldenParameters({ "contact.smoothing=" + GetParam() }));
    auto& worn = model.edit<WaveGeneratorContact>();
    for (int i = 0; i < model.rest.teeth(); ++i)
    {
      worn.gap()[i] = 1e-6 * (7 * i % 50);
    }
    if (!sound)
    {
      worn.bearing().addIdleBall(3, 40e-6);
      worn.bearing().addOuterSpall(0.3, 30e-6, 5e-3);
    }
    const ElementUnderTest contact = elementOf<WaveGeneratorContact>(model);
    RandomRing ring(13);
    for (int k = 0; k < 4;)
    {
      const auto [shape, position] = ring.draw(model);
      const Eigen::ArrayXd depth = contact.forces(shape, position).of<WaveGeneratorContact>().depth.array();
      if (GetParam() == "0.0" && depth.abs().minCoeff() < 1e-8)
      {
        continue;  // a tooth so near the kink of the law that a difference would straddle it
      }
      SCOPED_TRACE((sound ? "sound bearing, shape " : "faulty bearing, shape ") + std::to_string(k++));
      expectGradientAndTangent(contact, shape, position);
    }
  }
}

TEST_P(WaveGeneratorContactNormal, SurfaceAdvancesByTheAmplitudeAsTheEnergyTells)
{
  const RingModel model(goldenParameters({ "contact.smoothing=" + GetParam() }));
  const ElementUnderTest contact = elementOf<WaveGeneratorContact>(model);
  RandomRing ring(26);
  for (int k = 0; k < 12; ++k)
  {
    const auto [shape, position] = ring.draw(model);
    const RingForces forces = contact.forces(shape, position);
    Eigen::VectorXd surface(shape.teeth());
    model.of<WaveGeneratorContact>().surfaceByAmplitude(position, forces.of<WaveGeneratorContact>(), surface);
    const double force = forces.of<WaveGeneratorContact>().force.dot(surface);
    constexpr double STEP = 1e-9;  // m
    DrivePosition before = position;
    DrivePosition after = position;
    before.wave_amplitude -= STEP;
    after.wave_amplitude += STEP;
    const double difference = (contact.forces(shape, after).energy - contact.forces(shape, before).energy) /
                              (after.wave_amplitude - before.wave_amplitude);
    // Contacts that open within the step count by half its square: some 1e8 N/m * 1e-9 m for a few of 200 teeth.
    EXPECT_NEAR(force, difference, 1e-6 * std::abs(force) + 0.1) << k;
  }
}

TEST(WaveGeneratorContact, PolarLawIsThatOfTheThesis)
{
  const Parameters parameters = thesisParameters();
  const RingModel model(parameters);
  RandomRing ring(7);
  const auto [shape, position] = ring.draw(model);
  const RingForces forces = elementOf<WaveGeneratorContact>(model).forces(shape, position);
  const double a = parameters.gear.flexspline_inner_radius + position.wave_amplitude;
  const double b = parameters.gear.flexspline_inner_radius - position.wave_amplitude;
  const Eigen::VectorXd own = turned(shape.points, -position.wave_generator_angle);
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const Eigen::Vector2d point = own.segment<2>(2 * i);
    const double psi = std::atan2(point.y(), point.x());
    const double alpha = std::atan2(a * a * point.y(), b * b * point.x());
    const Eigen::Vector2d normal(std::cos(alpha), std::sin(alpha));
    const double depth = (Eigen::Vector2d(a * std::cos(psi), b * std::sin(psi)) - point).dot(normal);
    // Depths are rounded to some 1e-17 m, times the stiffness.
    EXPECT_NEAR(forces.of<WaveGeneratorContact>().force[i], parameters.contact.stiffness * std::max(depth, 0.0), 1e-8);
    const double turn = alpha + position.wave_generator_angle;
    EXPECT_NEAR(forces.of<WaveGeneratorContact>().normal[2 * i], std::cos(turn), 1e-12);
    EXPECT_NEAR(forces.of<WaveGeneratorContact>().normal[2 * i + 1], std::sin(turn), 1e-12);
  }
}

/// delta = 4.36e-4 Q^(2/3) d^(-1/3), mm and N: 500 N press a ball of 6.35 mm in by 14.8 um.
TEST(HertzContact, HasPalmgrensApproach)
{
  const double diameter = 6.35e-3;
  const double depth = 1e-3 * 4.36e-4 * std::pow(500.0, 2.0 / 3.0) / std::cbrt(1e3 * diameter);
  EXPECT_NEAR(depth, 14.8e-6, 0.1e-6);
  EXPECT_NEAR(hertzStiffness(diameter) * HertzContact(depth).force, 500.0, 1e-9);
  EXPECT_EQ(HertzContact(-depth).force, 0.0);
  EXPECT_EQ(HertzContact(-depth).energy, 0.0);
  EXPECT_EQ(HertzContact(0.0).tangent, 0.0);
}

/// A round ring, everywhere as deep: the balls share its force, spread or single.
TEST(WaveGeneratorContact, BallsCarryARoundRingAlike)
{
  for (const std::string support : { "balls", "single_balls" })
  {
    const Parameters parameters = goldenParameters({ "contact.support=" + support, "contact.fit=10.0e-6" });
    const RingModel model(parameters);
    RingShape shape = model.restShape({});
    const RingForces forces = elementOf<WaveGeneratorContact>(model).forces(shape, { 0.3, 0.0, 0.0 });
    const double ball = hertzStiffness(parameters.bearing.ball_diameter) * std::pow(10e-6, 1.5);
    EXPECT_NEAR(forces.of<WaveGeneratorContact>().force.sum(), parameters.bearing.balls * ball, 1e-6 * ball) << support;
    EXPECT_NEAR(forces.energy, parameters.bearing.balls * 0.4 * 10e-6 * ball, 1e-6 * ball * 10e-6) << support;
  }
}

/// 3 K are worth 1.04 um of fit: steel of 30.3 mm grows by 0.35 um a kelvin.
TEST(WaveGeneratorContact, GrowsWithItsTemperature)
{
  const Parameters parameters = goldenParameters({ "contact.temperature_difference=3.0" });
  const double growth = 3.0 * 11.5e-6 * parameters.gear.flexspline_inner_radius;
  const RingModel model(parameters);
  const RingForces forces = elementOf<WaveGeneratorContact>(model).forces(model.restShape({}), { 0.3, 0.0, 0.0 });
  EXPECT_NEAR(forces.of<WaveGeneratorContact>().depth.mean(), growth, 1e-6 * growth);
}

/// Each ball at its place, on a sound bearing and where balls drop.
class OnSingleBalls : public testing::TestWithParam<bool>
{
protected:
  OnSingleBalls()
  {
    auto& contact = model_.edit<WaveGeneratorContact>();
    if (!GetParam())
    {
      contact.bearing().addIdleBall(3, 40e-6);
      contact.bearing().addOuterSpall(0.3, 30e-6, 5e-3);
      contact.bearing().addInnerSpall(0.2, 30e-6, 5e-3);
    }
    for (int i = 0; i < model_.rest.teeth(); ++i)
    {
      contact.gap()[i] = 1e-6 * (7 * i % 20);
    }
  }

  /// A shape of which no ball just begins to carry.
  void draw(RandomRing& ring)
  {
    double nearest = 0.0;
    while (nearest < HERTZ_KINK)
    {
      placed_ = ring.draw(model_);
      const RingForces forces = contact_.forces(shape_, position_);
      nearest = 1.0;
      for (int b = 0; b < parameters_.bearing.balls; ++b)
      {
        nearest = std::min(nearest, std::abs(forces.of<WaveGeneratorContact>().balls[b].depth));
      }
    }
  }

  const Parameters parameters_ = goldenParameters({ "contact.support=single_balls" });
  RingModel model_{ parameters_ };
  const ElementUnderTest contact_ = elementOf<WaveGeneratorContact>(model_);
  PlacedRing placed_{ RingShape(model_.rest.teeth()), {} };
  RingShape& shape_ = placed_.shape;
  DrivePosition& position_ = placed_.position;
};
INSTANTIATE_TEST_SUITE_P(Sound, OnSingleBalls, testing::Values(true));
INSTANTIATE_TEST_SUITE_P(Faulty, OnSingleBalls, testing::Values(false));

TEST_P(OnSingleBalls, IsTheGradientOfItsEnergy)
{
  RandomRing ring(31);
  for (int k = 0; k < 6; ++k)
  {
    draw(ring);
    SCOPED_TRACE("shape " + std::to_string(k));
    expectGradientAndTangent(contact_, shape_, position_);
  }
}

/// A ball wherever it is between two teeth has the same stiffness in all.
TEST_P(OnSingleBalls, BallsAddUpToTheForceOnTheTeeth)
{
  RandomRing ring(32);
  draw(ring);
  const RingForces forces = contact_.forces(shape_, position_);
  const auto& found = forces.of<WaveGeneratorContact>();
  double sum = 0.0;
  for (int b = 0; b < parameters_.bearing.balls; ++b)
  {
    const SingleBalls::Ball& ball = found.balls[b];
    sum += ball.force;
    EXPECT_NEAR(ball.weight[0] + ball.weight[1] + ball.weight[2], 1.0, 1e-15);
    EXPECT_NEAR(ball.rate[0] + ball.rate[1] + ball.rate[2], 0.0, 1e-12);
  }
  EXPECT_GT(sum, 0.0);
  EXPECT_NEAR(found.force.sum(), sum, 1e-12 * sum);
}

/// After a turn of all by which the cage goes on by one ball, the balls lie under the rim as before.
TEST_P(OnSingleBalls, KeepsItsEnergyUnderARigidTurnToTheNextBall)
{
  if (!GetParam())
  {
    GTEST_SKIP() << "a fault of one ball is not that of the next";
  }
  RandomRing ring(33);
  draw(ring);
  const RingForces forces = contact_.forces(shape_, position_);
  const double angle = TWO_PI / parameters_.bearing.balls / model_.of<WaveGeneratorContact>().bearing().cageRate();
  RingShape moved = shape_;
  moved.points = turned(shape_.points, angle);
  moved.updateGeometry();
  const RingForces after = contact_.forces(
      moved, { position_.wave_generator_angle + angle, position_.output_angle, position_.wave_amplitude });
  EXPECT_LT(relativeError(turned(forces.teeth, angle), after.teeth), 1e-9);
  EXPECT_NEAR(after.energy, forces.energy, 1e-9 * forces.energy);
  EXPECT_NEAR(after.wave_generator_torque, forces.wave_generator_torque,
              1e-9 * (1.0 + std::abs(forces.wave_generator_torque)));
}
}  // namespace
}  // namespace hjt
