// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ring_equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "model/joint_model.hpp"
#include "ring_fixture.hpp"
#include "solver/ring_state.hpp"
#include "test/core/ring_equilibrium_support.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
TEST_F(Ring, SettlesWhereItMovesIfNothingSnaps)
{
  ASSERT_TRUE(moveTo(0.0, -2e-3).ok());
  const Eigen::VectorXd moved = ring_.shape().points;
  const double energy = ring_.forces().energy;
  ASSERT_TRUE(moveTo(0.0, -1.8e-3).ok());
  ASSERT_TRUE(ring_.descend(at(0.0, -2e-3)).ok());
  // One minimum of the energy, found twice; forces to 5e-7 N over the softest way of the ring, some 1e4 N/m.
  EXPECT_LT((ring_.shape().points - moved).lpNorm<Eigen::Infinity>(), 1e-10);
  EXPECT_NEAR(ring_.forces().energy, energy, 1e-9 * energy);
}

TEST(RingOnASoftWaveGenerator, SettlesDownhillWhereAToothLeavesItsSpace)
{
  // Teeth at the end of the mesh leave their spaces one by one: there no path leads on from where they were.
  const Parameters parameters = goldenParameters({ "contact.stiffness=1.0e+6" });
  const RingModel model(parameters);
  RingEquilibrium ring(model, parameters.solver);
  DrivePosition position{ 0.0, 0.0, parameters.gear.wave_amplitude };
  ASSERT_TRUE(ring.insert(position).ok());
  int settled = 0;
  for (int i = 0; i < 100 && settled < 3; ++i)
  {
    position.output_angle -= 1e-4;
    if (ring.moveTo(position).ok())
    {
      continue;
    }
    RingForces forces(model.rest.teeth());
    model.forces(ring.shape(), position, forces);
    const SolveStatus status = ring.descend(position);
    ASSERT_TRUE(status.ok()) << position.output_angle;
    EXPECT_LE(status.residual, parameters.solver.force_tolerance);
    EXPECT_LT(ring.forces().energy, forces.energy);
    EXPECT_EQ(ring.position().output_angle, position.output_angle);
    ++settled;
  }
  EXPECT_EQ(settled, 3);
}

TEST_F(Ring, IsInEquilibriumWhereItSaysSo)
{
  for (const double twist : { 0.0, -0.5e-3, 3e-3, -6e-3 })
  {
    const SolveStatus status = moveTo(0.3, 0.3 / ratio() + twist);
    ASSERT_TRUE(status.ok()) << twist;
    RingShape shape = ring_.shape();
    shape.updateGeometry();
    RingForces forces(shape.teeth());
    model_.forces(shape, ring_.position(), forces);
    EXPECT_LE(forces.teeth.lpNorm<Eigen::Infinity>(), parameters_.solver.force_tolerance);
    EXPECT_EQ(forces.energy, ring_.forces().energy);
    EXPECT_EQ(forces.output_torque, ring_.forces().output_torque);
    EXPECT_EQ(ring_.position().output_angle, 0.3 / ratio() + twist);
  }
}

/// Also where nobody has called updateModel().
TEST_F(Ring, IsSolvedAgainOnceItsModelHasChanged)
{
  ASSERT_TRUE(moveTo(0.3, 0.3 / ratio() - 2e-3).ok());
  const double energy = ring_.forces().energy;
  model_.edit<ToothMesh>().stiffness() *= 0.5;
  ASSERT_TRUE(ring_.moveTo(ring_.position()).ok());
  EXPECT_LT(ring_.forces().energy, 0.999 * energy);
  RingEquilibrium fresh(model_, parameters_.solver);
  ASSERT_TRUE(fresh.insert({ 0.0, 0.0, parameters_.gear.wave_amplitude }).ok());
  ASSERT_TRUE(fresh.moveTo(ring_.position()).ok());
  EXPECT_NEAR(ring_.forces().energy, fresh.forces().energy, 1e-9 * energy);
  // Of a tangent at most a Newton step away (see RingEquilibrium::byWaveGenerator); that of the old model is off by
  // 2e-2.
  EXPECT_NEAR(ring_.stiffness()(1, 1), fresh.stiffness()(1, 1), 1e-4 * fresh.stiffness()(1, 1));
}

TEST_F(Ring, IsTwoFoldSymmetric)
{
  ASSERT_TRUE(moveTo(0.3, 0.3 / ratio() - 2e-3).ok());
  const int half = model_.rest.teeth() / 2;
  for (int i = 0; i < half; ++i)
  {
    // Equilibrium to 5e-7 N over the softest contact in the ring, some 1e5 N/m.
    EXPECT_NEAR((ring_.shape().points.segment<2>(2 * i) + ring_.shape().points.segment<2>(2 * (i + half))).norm(), 0.0,
                5e-12);
    EXPECT_NEAR(ring_.forces().of<ToothMesh>().flank_force[i], ring_.forces().of<ToothMesh>().flank_force[i + half],
                1e-4)
        << i;
    EXPECT_NEAR(ring_.forces().of<WaveGeneratorContact>().force[i],
                ring_.forces().of<WaveGeneratorContact>().force[i + half], 1e-4)
        << i;
  }
}

TEST_F(Ring, HasNoLeftAndRight)
{
  ASSERT_TRUE(moveTo(0.01, -2e-3).ok());
  const Eigen::VectorXd points = ring_.shape().points;
  const RingForces forces = ring_.forces();
  ASSERT_TRUE(moveTo(-0.01, 2e-3).ok());
  EXPECT_LT((mirrored(points) - ring_.shape().points).lpNorm<Eigen::Infinity>(), 5e-12);
  EXPECT_NEAR(ring_.forces().energy, forces.energy, 1e-9 * forces.energy);
  EXPECT_NEAR(ring_.forces().output_torque, -forces.output_torque, 1e-6 * std::abs(forces.output_torque));
  EXPECT_NEAR(ring_.forces().wave_generator_torque, -forces.wave_generator_torque,
              1e-6 * std::abs(forces.wave_generator_torque));
}

TEST_F(Ring, RepeatsEveryToothPitchReachedInSmallSteps)
{
  constexpr int STEPS = 37;
  ASSERT_TRUE(moveTo(0.1, 0.1 / ratio() - 1.5e-3).ok());
  const Eigen::VectorXd points = ring_.shape().points;
  const RingForces forces = ring_.forces();
  for (int i = 1; i <= STEPS; ++i)
  {
    const double turn = pitch() * i / STEPS;
    ASSERT_TRUE(moveTo(0.1 + turn, (0.1 + turn) / ratio() - 1.5e-3).ok());
  }
  expectShifted(points, forces, ring_, 1);
}

TEST_F(Ring, RepeatsEveryToothPitchReachedAtOnce)
{
  ASSERT_TRUE(moveTo(0.1, 0.1 / ratio() - 1.5e-3).ok());
  const Eigen::VectorXd points = ring_.shape().points;
  const RingForces forces = ring_.forces();
  int total = 0;
  for (const int pitches : { 1, -1, 7, -30, 150 })
  {
    total += pitches;
    const double angle = 0.1 + total * pitch();
    ASSERT_TRUE(moveTo(angle, angle / ratio() - 1.5e-3).ok()) << pitches;
    expectShifted(points, forces, ring_, total);
  }
}

TEST_F(Ring, GivesTheSameStateByEveryPath)
{
  ASSERT_TRUE(moveTo(0.2, 0.2 / ratio() - 1e-3).ok());
  const Eigen::VectorXd points = ring_.shape().points;
  const double energy = ring_.forces().energy;
  for (const double way : { 0.25, 0.19, 0.1, -0.3 })
  {
    ASSERT_TRUE(moveTo(way, way / ratio() + 1e-3).ok());
    ASSERT_TRUE(moveTo(0.2, 0.2 / ratio() - 1e-3).ok());
    EXPECT_LT((points - ring_.shape().points).lpNorm<Eigen::Infinity>(), 5e-12) << way;
    EXPECT_NEAR(ring_.forces().energy, energy, 1e-9 * energy) << way;
  }
  RingEquilibrium cold(model_, parameters_.solver);
  ASSERT_TRUE(cold.insert(at(0.2, 0.2 / ratio() - 1e-3)).ok());
  EXPECT_LT((points - cold.shape().points).lpNorm<Eigen::Infinity>(), 5e-12);
}

/// In random motion, shipped and with errors of manufacture, to what a table of the ring is trusted to.
TEST(RingThatIsFollowed, HasTheTorquesOfTheEquilibrium)
{
  constexpr int STEPS = 1000;
  constexpr int SPELL = 25;        // steps at one speed
  constexpr double TABLED = 2e-6;  // of the output's angle at given torque [rad]
  for (const std::vector<std::string>& errors :
       { std::vector<std::string>{}, std::vector<std::string>{ "manufacture.flexspline_pitch_deviation=4.0e-6" } })
  {
    const Parameters parameters = shippedParameters(errors);
    const RingModel model(parameters);
    RingEquilibrium ring(model, parameters.solver);
    const double w = parameters.gear.wave_amplitude;
    ASSERT_TRUE(ring.insert({ 0.0, 0.0, w }).ok());
    std::mt19937 random(58);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    Eigen::Vector2d step(0.0, 0.0);  // of the motor and of the twist [rad]
    Eigen::Vector2d turned(0.0, 0.0);
    for (int i = 0; i < STEPS; ++i)
    {
      if (i % SPELL == 0)
      {
        step = { part(random) * model.rest.pitchAngle(), part(random) * 2e-5 };
      }
      turned += step;
      ASSERT_TRUE(ring.follow({ turned[0], turned[0] / nominalRatio(parameters.gear) + turned[1], w }).ok()) << i;
      RingEquilibrium exact = ring;
      ASSERT_TRUE(exact.moveTo(ring.position()).ok());
      const double torque = TABLED * exact.stiffness()(1, 1);
      EXPECT_NEAR(ring.torques()[1], exact.torques()[1], torque) << i;
      EXPECT_NEAR(ring.torques()[0], exact.torques()[0], torque / nominalRatio(parameters.gear)) << i;
    }
  }
}

TEST_F(Ring, SensitivitiesAreTheRatesOfTheMovingRing)
{
  expectSensitivitiesToBeRates(false);
}

TEST(RingSensitivities, BelongToTheShapeAlsoAfterLongSteps)
{
  // Steps as at full motor speed, 317 rad/s at 10 kHz. Newton may keep old factors, but not across a change of
  // contacts.
  constexpr unsigned SEED = 51;
  SCOPED_TRACE("seed " + std::to_string(SEED));
  std::mt19937 random(SEED);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  const Parameters parameters = goldenParameters();
  const RingModel model(parameters);
  const double w = parameters.gear.wave_amplitude;
  RingEquilibrium ring(model, parameters.solver);
  ASSERT_TRUE(ring.insert({ 0.0, 0.0, w }).ok());
  CyclicSolver solver(model.rest.teeth());
  double angle = 0.0;
  double twist = 0.0;
  double worst = 0.0;
  for (int k = 0; k < 6000; ++k)
  {
    angle += 0.0317 * part(random);
    twist = 0.999 * (twist + 1e-4 * part(random));
    ASSERT_TRUE(ring.moveTo({ angle, angle / nominalRatio(parameters.gear) + twist, w }).ok());
    const RingTangent tangent = wholeTangent(ring);
    ASSERT_TRUE(solver.factor(tangent));
    Eigen::VectorXd by_output = -tangent.output;
    solver.solve<1>(by_output);
    const double stiffness = tangent.output_stiffness + tangent.output.dot(by_output);
    worst = std::max(worst, std::abs(ring.stiffness()(1, 1) - stiffness) / stiffness);
  }
  testing::Test::RecordProperty("worst_relative_error", testing::PrintToString(worst));
  EXPECT_LT(worst, 0.01);
}

TEST_F(Ring, StoresTheWorkDoneOnIt)
{
  // Round a closed way through the plane of both angles, with teeth coming into mesh and leaving it on all sides of it:
  // along each leg the work of the torques is what the stored energy has changed by, and in all it is nothing.
  constexpr int STEPS = 400;
  const std::vector<Eigen::Vector2d> corners{
    { 0.0, -1e-3 }, { 0.1, 1e-3 }, { 0.08, 3e-3 }, { -0.02, -2e-3 }, { 0.0, -1e-3 }
  };
  const auto angles = [&](std::size_t leg, double part)
  {
    const Eigen::Vector2d corner = corners[leg] + part * (corners[leg + 1] - corners[leg]);
    return Eigen::Vector2d(corner[0], corner[0] / ratio() + corner[1]);
  };
  ASSERT_TRUE(moveTo(angles(0, 0.0)[0], angles(0, 0.0)[1]).ok());
  const double start = ring_.forces().energy;
  double total = 0.0;
  double throughput = 0.0;
  for (std::size_t leg = 0; leg + 1 < corners.size(); ++leg)
  {
    const double before = ring_.forces().energy;
    const Eigen::Vector2d way = angles(leg, 1.0) - angles(leg, 0.0);
    double work = 0.0;
    for (int i = 0; i <= STEPS; ++i)
    {
      const Eigen::Vector2d to = angles(leg, static_cast<double>(i) / STEPS);
      ASSERT_TRUE(moveTo(to[0], to[1]).ok());
      const double power = -ring_.forces().wave_generator_torque * way[0] - ring_.forces().output_torque * way[1];
      const double weight = (i == 0 || i == STEPS ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) / (3.0 * STEPS);
      work += weight * power;
      throughput += weight * std::abs(power);
    }
    // Simpson's rule over torques with kinks where teeth touch.
    EXPECT_NEAR(work, ring_.forces().energy - before, 1e-5 * throughput) << leg;
    total += work;
  }
  EXPECT_NEAR(total, 0.0, 1e-5 * throughput);
  EXPECT_NEAR(ring_.forces().energy, start, 1e-9 * throughput);
}

TEST(RingVectors, AddASumThatIsTurned)
{
  constexpr int TEETH = 12;
  constexpr int SOLVED = 6;
  constexpr double ANGLE = 0.7;
  const Eigen::MatrixX3d all = Eigen::MatrixX3d::Random(2 * TEETH, 3);
  const Eigen::VectorXd a = all.col(0);
  const Eigen::VectorXd b = all.col(1);
  const Eigen::VectorXd c = all.col(2);
  for (const int places : { 1, 4, 11 })
  {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(2 * TEETH);
    ring_vectors::addTurned({ a.data(), b.data(), c.data() }, { 1.0, 2.0, 3.0 }, { 4.0, 5.0, 6.0 }, places,
                            std::cos(ANGLE), std::sin(ANGLE), sum, SOLVED);
    for (int i = 0; i < SOLVED; ++i)
    {
      const int from = (i - places + TEETH) % TEETH;
      const Eigen::Vector2d expected =
          all.middleRows<2>(2 * i) * Eigen::Vector3d(1.0, 2.0, 3.0) +
          Eigen::Rotation2Dd(ANGLE) * (all.middleRows<2>(2 * from) * Eigen::Vector3d(4.0, 5.0, 6.0));
      EXPECT_LT((sum.segment<2>(2 * i) - expected).norm(), 1e-13) << places << ' ' << i;
    }
  }
}

TEST(RingWithoutCircularSpline, TakesTheShapeOfThinRingTheoryForASmallWave)
{
  // v = -(w/2) sin 2 psi, tilt -(3 w / 2 r) sin 2 psi, to leading order in w: the relative error falls with w. The wave
  // shrinks as far as the rim's own bending leaves it on the wave generator all round.
  const Parameters parameters = goldenParameters({ TIGHT });
  const double r = parameters.gear.flexspline_inner_radius;
  RingModel model(parameters);
  model.setMeshed(false);
  RingEquilibrium ring(model, parameters.solver);
  ASSERT_TRUE(ring.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }).ok());
  double last_error = 0.0;
  for (const double part : { 1.0, 0.7, 0.49 })
  {
    const double w = part * parameters.gear.wave_amplitude;
    ASSERT_TRUE(ring.moveTo({ 0.0, 0.0, w }).ok());
    ASSERT_GT(ring.forces().of<WaveGeneratorContact>().force.minCoeff(), 0.0);
    double error = 0.0;
    double tilt_error = 0.0;
    for (int i = 0; i < model.rest.teeth(); ++i)
    {
      const double psi = i * model.rest.pitchAngle();
      const Eigen::Vector2d point = ring.shape().points.segment<2>(2 * i);
      const Eigen::Vector2d radial = model.rest.radial().segment<2>(2 * i);
      const double v = radial.x() * point.y() - radial.y() * point.x();
      error = std::max(error, std::abs(v + 0.5 * w * std::sin(2.0 * psi)) / (0.5 * w));
      const Eigen::Vector2d chord = ring.shape().points.segment<2>(2 * ring.shape().next(i)) -
                                    ring.shape().points.segment<2>(2 * ring.shape().previous(i));
      // The chord stands across the radius at rest.
      const double tilt = std::atan2(-chord.dot(radial), radial.x() * chord.y() - radial.y() * chord.x());
      // The outward normal turns by (v - dw/dpsi) / r.
      tilt_error = std::max(tilt_error, std::abs(tilt - 1.5 * w / r * std::sin(2.0 * psi)) / (1.5 * w / r));
    }
    // Of the next order, w / r; the factor is of order one.
    EXPECT_LT(error, 0.2 * w / r);
    EXPECT_LT(tilt_error, w / r);
    if (last_error > 0.0)
    {
      EXPECT_NEAR(error / last_error, 0.7, 0.02);
    }
    last_error = error;
  }
}
}  // namespace
}  // namespace hjt
