// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ring_equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "model/joint_model.hpp"
#include "ring_fixture.hpp"
#include "test/core/ring_equilibrium_support.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
/// The ring on the balls of the bearing.
class RingOnBalls : public Ring, public testing::WithParamInterface<std::string>
{
protected:
  RingOnBalls() : Ring({ TIGHT, "contact.support=" + GetParam() }) {}
};
INSTANTIATE_TEST_SUITE_P(Supports, RingOnBalls, testing::Values("balls", "single_balls"));

TEST_P(RingOnBalls, SensitivitiesAreTheRatesOfTheMovingRing)
{
  // A ball that just touches changes its stiffness with the root of its depth: a Newton step away the rates of the
  // points differ by up to 1 %, the stiffness by 0.1 %.
  expectSensitivitiesToBeRates(true);
}

TEST_P(RingOnBalls, GivesTheSameStateByEveryPath)
{
  ASSERT_TRUE(moveTo(0.2, 0.2 / ratio() - 1e-3).ok());
  const Eigen::VectorXd points = ring_.shape().points;
  for (const double way : { 0.25, 0.19, 0.1, -0.3 })
  {
    ASSERT_TRUE(moveTo(way, way / ratio() + 1e-3).ok());
    ASSERT_TRUE(moveTo(0.2, 0.2 / ratio() - 1e-3).ok());
    EXPECT_LT((points - ring_.shape().points).lpNorm<Eigen::Infinity>(), 5e-11) << way;
  }
}

TEST_P(RingOnBalls, RepeatsEveryToothPitchUnlessTheBallsAreSingle)
{
  ASSERT_TRUE(moveTo(0.1, 0.1 / ratio() - 1.5e-3).ok());
  const Eigen::VectorXd points = ring_.shape().points;
  const RingForces forces = ring_.forces();
  ASSERT_TRUE(moveTo(0.1 + 7 * pitch(), (0.1 + 7 * pitch()) / ratio() - 1.5e-3).ok());
  if (GetParam() == "balls")
  {
    expectShifted(points, forces, ring_, 7);
  }
  else
  {
    EXPECT_GT(std::abs(ring_.forces().energy - forces.energy), 1e-6 * forces.energy);
  }
}

/// One that has dropped out of reach carries nothing, and those beside it carry more.
TEST(RingOnSingleBalls, GoesOnWithoutOneOfThem)
{
  const Parameters parameters = shippedParameters({ "contact.support=single_balls" });
  RingModel model(parameters);
  RingEquilibrium ring(model, parameters.solver);
  ASSERT_TRUE(ring.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }).ok());
  ASSERT_TRUE(balanceOutput(ring, 0.0, 67.0).ok());
  const auto force = [&](int ball) { return ring.forces().of<WaveGeneratorContact>().balls[ball].force; };
  const double before = force(0);
  const double after = force(2);
  EXPECT_GT(force(1), 100.0);
  model.edit<WaveGeneratorContact>().bearing().addIdleBall(1, 0.1e-3);
  ASSERT_TRUE(ring.updateModel().ok());
  ASSERT_TRUE(balanceOutput(ring, 0.0, 67.0).ok());
  EXPECT_EQ(force(1), 0.0);
  EXPECT_GT(force(0), 1.05 * before);
  EXPECT_GT(force(2), 1.05 * after);
}

/// Forces on the wave generator by fit and load from an energy function of its own (numpy), with which no code is
/// shared: of the golden gear on single balls, rim 258 and race 670 N.m/rad.
TEST(RingOnSingleBalls, HasTheForcesOfAnIndependentSolution)
{
  const auto solve = [](double fit, double torque, const auto& look)
  {
    const Parameters parameters =
        goldenParameters({ "contact.support=single_balls", "ring.bending_stiffness=258.0",
                           "bearing.race_bending_stiffness=670.0", "contact.fit=" + std::to_string(fit) + "e-6" });
    const RingModel model(parameters);
    RingEquilibrium ring(model, parameters.solver);
    ASSERT_TRUE(ring.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }).ok());
    ASSERT_TRUE(balanceOutput(ring, 0.0, torque).ok());
    look(ring.forces().of<WaveGeneratorContact>());
  };
  using Contact = WaveGeneratorContact::Scratch;
  struct Fit
  {
    double fit;  // um
    double force;
  };
  for (const Fit& row : { Fit{ -2.0, 475.0 }, Fit{ -1.0, 490.0 }, Fit{ 0.0, 512.0 }, Fit{ 1.0, 549.0 },
                          Fit{ 2.0, 710.0 }, Fit{ 5.0, 1687.0 } })
  {
    solve(row.fit, 5.0, [&](const Contact& found) { EXPECT_NEAR(found.force.sum(), row.force, 0.002 * row.force); });
  }
  struct Load
  {
    double torque;
    double hardest;
  };
  for (const Load& row : { Load{ 14.0, 98.0 }, Load{ 67.0, 324.0 }, Load{ 150.0, 617.0 } })
  {
    solve(0.0, row.torque,
          [&](const Contact& found)
          {
            double hardest = 0.0;
            for (int b = 0; b < 23; ++b)
            {
              hardest = std::max(hardest, found.balls[b].force);
            }
            EXPECT_NEAR(hardest, row.hardest, 0.005 * row.hardest);
          });
  }
}

struct HalfRing : testing::TestWithParam<const char*>
{
};
INSTANTIATE_TEST_SUITE_P(Gears, HalfRing, testing::Values("shipped", "golden"));

TEST_P(HalfRing, IsTheWholeRing)
{
  constexpr unsigned SEED = 52;
  constexpr double NEXT_TO_NOTHING = 1e-30;  // m, of one tooth's clearance: the halves differ, and no force does
  SCOPED_TRACE("seed " + std::to_string(SEED));
  std::mt19937 random(SEED);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  const Parameters parameters = std::string(GetParam()) == "golden" ? goldenParameters() : shippedParameters();
  const RingModel model(parameters);
  RingModel different(parameters);
  different.edit<ToothMesh>().clearance()[7] = NEXT_TO_NOTHING;
  ASSERT_EQ(model.solvedTeeth(), 100);
  ASSERT_EQ(different.solvedTeeth(), 200);
  const double w = parameters.gear.wave_amplitude;
  RingEquilibrium half(model, parameters.solver);
  RingEquilibrium whole(different, parameters.solver);
  ASSERT_TRUE(half.insert({ 0.0, 0.0, w }).ok());
  ASSERT_TRUE(whole.insert({ 0.0, 0.0, w }).ok());
  ASSERT_EQ(half.shape().solved, 100);
  ASSERT_EQ(whole.shape().solved, 200);
  const double rate_size = whole.byWaveGenerator().norm();
  double angle = 0.0;
  double twist = 0.0;
  for (int k = 0; k < 200; ++k)
  {
    angle += 0.03 * part(random);
    twist = 0.99 * twist + 2e-4 * part(random);
    const DrivePosition position{ angle, angle / nominalRatio(parameters.gear) + twist, w };
    ASSERT_TRUE(half.moveTo(position).ok());
    ASSERT_TRUE(whole.moveTo(position).ok());
    // Each is within the tolerance of its own forces; the rates are of the shape a Newton step before.
    ASSERT_TRUE(half.refreshSensitivities() && whole.refreshSensitivities());
    const auto near = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b, double tolerance)
    { EXPECT_LT((a - b).lpNorm<Eigen::Infinity>(), tolerance) << "step " << k; };
    near(half.shape().points, whole.shape().points, 1e-10);
    near(half.forces().of<WaveGeneratorContact>().force, whole.forces().of<WaveGeneratorContact>().force, 1e-3);
    near(half.forces().of<ToothMesh>().flank_force, whole.forces().of<ToothMesh>().flank_force, 1e-3);
    near(half.forces().of<RimBending>().moment, whole.forces().of<RimBending>().moment, 1e-6);
    EXPECT_EQ(half.forces().of<ToothMesh>().meshed, whole.forces().of<ToothMesh>().meshed) << k;
    EXPECT_EQ(half.shape().space, whole.shape().space) << k;
    EXPECT_NEAR(half.forces().output_torque, whole.forces().output_torque, 1e-3);
    EXPECT_NEAR(half.forces().wave_generator_torque, whole.forces().wave_generator_torque, 1e-5);
    EXPECT_NEAR(half.forces().energy, whole.forces().energy, 1e-6);
    near(half.byWaveGenerator(), whole.byWaveGenerator(), 1e-5 * rate_size);
    near(half.byOutput(), whole.byOutput(), 1e-5 * rate_size);
    EXPECT_LT((half.stiffness() - whole.stiffness()).norm(), 1e-5 * whole.stiffness().norm());

    JointFriction friction(200);
    JointFriction whole_friction(200);
    const JointModel joint(parameters);
    const JointModel::Running running{ { 100.0, 1.0 }, 0.0, 1e-4 };
    joint.friction(half.forces(), { half.shape(), half.byWaveGenerator(), half.byOutput() }, half.velocityRatio(),
                   running, friction);
    joint.friction(whole.forces(), { whole.shape(), whole.byWaveGenerator(), whole.byOutput() }, whole.velocityRatio(),
                   running, whole_friction);
    const double power = whole_friction.dryPower(running.speeds);
    EXPECT_NEAR(friction.dryPower(running.speeds), power, 1e-5 * power);
    EXPECT_LT((friction.viscous - whole_friction.viscous).norm(), 1e-5 * whole_friction.viscous.norm());
  }
}
}  // namespace
}  // namespace hjt
