// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "element_under_test.hpp"
#include "elements/contact_laws.hpp"
#include "elements/ring_friction.hpp"
#include "gear/angle.hpp"
#include "random_ring.hpp"
#include "test/core/elements_support.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
TEST(RimTension, HasTheEnergyOfItsSprings)
{
  const Parameters parameters = goldenParameters();
  const RingModel model(parameters);
  RandomRing ring(2);
  RingShape shape(model.rest.teeth());
  DrivePosition position;
  ring.draw(model, shape, position);
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
  RingShape shape(model.rest.teeth());
  DrivePosition position;
  ring.draw(model, shape, position);
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
  RingShape half(model.rest.teeth());
  DrivePosition position;
  ring.draw(model, half, position);
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

class RimBendingLaws : public testing::TestWithParam<std::string>
{
};
INSTANTIATE_TEST_SUITE_P(Both, RimBendingLaws, testing::Values("absolute", "curvature"));

TEST_P(RimBendingLaws, IsTheGradientOfItsEnergy)
{
  RingModel model(goldenParameters({ "ring.bending_law=" + GetParam() }));
  RandomRing ring(4);
  RingShape shape(model.rest.teeth());
  DrivePosition position;
  for (int k = 0; k < 4; ++k)
  {
    SCOPED_TRACE("shape " + std::to_string(k));
    ring.draw(model, shape, position);
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
  RingShape shape(model.rest.teeth());
  DrivePosition position;
  ring.draw(model, shape, position);
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
  RingShape shape(bare.rest.teeth());
  DrivePosition position;
  ring.draw(bare, shape, position);
  const RingForces race = elementOf<RimBending>(both).forces(shape, position);
  const RingForces rim = elementOf<RimBending>(bare).forces(shape, position);
  EXPECT_EQ(race.energy, rim.energy);
  EXPECT_TRUE(race.teeth == rim.teeth);
  cracked.stiffness().setConstant(50.0);
  expectGradientAndTangent(elementOf<RimBending>(both), shape, position);
}

class CupTorsionRanges : public testing::TestWithParam<double>
{
};
// Mean rotations [rad] on every slope of the law: the shipped breakpoints lie at 0.4516e-3 and 1.1316e-3 rad.
INSTANTIATE_TEST_SUITE_P(BothSigns, CupTorsionRanges,
                         testing::Values(0.3e-3, -0.3e-3, 0.8e-3, -0.8e-3, 5e-3, -5e-3, 0.3));

TEST_P(CupTorsionRanges, IsTheGradientOfItsEnergy)
{
  const RingModel model(goldenParameters());
  RingShape shape(model.rest.teeth());
  DrivePosition position{ 0.4, 0.1, 0.35e-3 };
  pressOnWaveGenerator(model.rest, position, GetParam(), shape);
  std::mt19937 random(8);
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
  RingShape shape(model.rest.teeth());
  DrivePosition position;
  for (int k = 0; k < 3;)
  {
    ring.draw(model, shape, position);
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
  RingShape shape(model_.rest.teeth());
  DrivePosition position;
  for (int k = 0; k < 10; ++k)
  {
    ring.draw(model_, shape, position);
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
  RingShape shape(model_.rest.teeth());
  DrivePosition position;
  for (const double angle : { 1e-3, -0.7, 2.0, PI })
  {
    ring.draw(model_, shape, position);
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
}  // namespace
}  // namespace hjt
