// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>

#include <Eigen/Geometry>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "model/joint_model.hpp"
#include "solver/ring_state.hpp"
#include "test/core/ring_fixture.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
// The rounding of a coordinate, some 1e-17 m, against 5e9 N/m: forces are not to be had better than to some 1e-7 N.
const std::string TIGHT = "solver.force_tolerance=5.0e-7";

// Newton keeps its factors while they serve, so the rates may belong to a shape a little way back; measured 2.5e-4.
constexpr double SENSITIVITY = 1e-3;

/// The shipped ring in equilibrium; positions are given without the wave amplitude, which stays full.
class Ring : public testing::Test, public InsertedRing
{
protected:
  explicit Ring(const std::vector<std::string>& assignments = { TIGHT }) : InsertedRing(goldenParameters(assignments))
  {
  }

  /// Wave generator at `angle`, the output `twist` off its share of it [rad].
  SolveStatus turnTo(double angle, double twist) { return moveTo(angle, angle / ratio() + twist); }

  /// At one angle, under loads of both senses.
  void expectSensitivitiesToBeRates(bool refactored)
  {
    for (const double twist : { -0.2e-3, -1e-3, 4e-3 })
    {
      SCOPED_TRACE("twist " + std::to_string(twist));
      const double angle = 0.1234;
      const double output = angle / ratio() + twist;
      ASSERT_TRUE(moveTo(angle - 1e-4, output).ok());
      ASSERT_TRUE(moveTo(angle, output).ok());
      if (refactored)
      {
        model.edit<RimTension>();  // as it is; but nobody knows that
        ASSERT_TRUE(ring.updateModel().ok());
      }
      const Eigen::VectorXd by_wave_generator = ring.byWaveGenerator();
      const Eigen::VectorXd by_output = ring.byOutput();
      const Eigen::Matrix2d stiffness = ring.stiffness();
      Eigen::Matrix2d numeric;
      for (const int column : { 0, 1 })
      {
        // So small that no tooth comes into contact or leaves it, so large that the tolerance of the solver, 5e-7 N
        // over 1e5 N/m, is no more than 1e-4 of the way of the points.
        const double step = column == 0 ? 2e-5 : 5e-7;
        const Eigen::Vector2d direction = step * Eigen::Vector2d::Unit(column);
        ASSERT_TRUE(moveTo(angle + direction[0], output + direction[1]).ok());
        const Eigen::VectorXd after = ring.shape().points;
        const Eigen::Vector2d torque_after(ring.forces().wave_generator_torque, ring.forces().output_torque);
        ASSERT_TRUE(moveTo(angle - direction[0], output - direction[1]).ok());
        const Eigen::Vector2d torque_before(ring.forces().wave_generator_torque, ring.forces().output_torque);
        const Eigen::VectorXd rate = (after - ring.shape().points) / (2.0 * step);
        const Eigen::VectorXd& expected = column == 0 ? by_wave_generator : by_output;
        EXPECT_LT((rate - expected).lpNorm<Eigen::Infinity>(), SENSITIVITY * expected.lpNorm<Eigen::Infinity>());
        numeric.col(column) = (torque_before - torque_after) / (2.0 * step);
      }
      EXPECT_NEAR(numeric(1, 1), stiffness(1, 1), SENSITIVITY * stiffness(1, 1));
      EXPECT_NEAR(numeric(0, 1), stiffness(0, 1), SENSITIVITY * std::abs(stiffness(0, 1)));
      EXPECT_NEAR(numeric(1, 0), stiffness(1, 0), SENSITIVITY * std::abs(stiffness(1, 0)));
      // The smallest: some 1 N.m/rad, a difference of terms a hundred times larger.
      EXPECT_NEAR(numeric(0, 0), stiffness(0, 0), SENSITIVITY * std::abs(stiffness(0, 1)));
    }
  }

  double pitch() const { return TWO_PI / parameters.gear.teeth_flexspline; }
  double ratio() const { return nominalRatio(parameters.gear); }
};

/// After one tooth pitch the state is the old one, turned by a pitch and renumbered.
void expectShifted(const Eigen::VectorXd& points, const RingForces& forces, const RingEquilibrium& ring, int pitches)
{
  const int n = ring.shape().teeth();
  const Eigen::VectorXd expected = turned(points, pitches * TWO_PI / n);
  for (int i = 0; i < n; ++i)
  {
    const int j = ((i + pitches) % n + n) % n;
    ASSERT_LT((expected.segment<2>(2 * i) - ring.shape().points.segment<2>(2 * j)).norm(), 5e-12) << i;
    ASSERT_NEAR(forces.of<ToothMesh>().flank_force[i], ring.forces().of<ToothMesh>().flank_force[j], 1e-4) << i;
  }
  EXPECT_NEAR(ring.forces().energy, forces.energy, 1e-9 * forces.energy);
  EXPECT_NEAR(ring.forces().output_torque, forces.output_torque, 1e-6 * std::abs(forces.output_torque));
}

TEST_F(Ring, SettlesWhereItMovesIfNothingSnaps)
{
  ASSERT_TRUE(moveTo(0.0, -2e-3).ok());
  const Eigen::VectorXd moved = ring.shape().points;
  const double energy = ring.forces().energy;
  ASSERT_TRUE(moveTo(0.0, -1.8e-3).ok());
  ASSERT_TRUE(ring.descend({ 0.0, -2e-3, amplitude }).ok());
  // One minimum of the energy, found twice; forces to 5e-7 N over the softest way of the ring, some 1e4 N/m.
  EXPECT_LT((ring.shape().points - moved).lpNorm<Eigen::Infinity>(), 1e-10);
  EXPECT_NEAR(ring.forces().energy, energy, 1e-9 * energy);
}

TEST(RingOnASoftWaveGenerator, SettlesDownhillWhereAToothLeavesItsSpace)
{
  // Teeth at the end of the mesh leave their spaces one by one: there no path leads on from where they were.
  InsertedRing inserted(goldenParameters({ "contact.stiffness=1.0e+6" }));
  RingEquilibrium& ring = inserted.ring;
  DrivePosition position = ring.position();
  int settled = 0;
  for (int i = 0; i < 100 && settled < 3; ++i)
  {
    position.output_angle -= 1e-4;
    if (ring.moveTo(position).ok())
    {
      continue;
    }
    RingForces forces(inserted.model.rest.teeth());
    inserted.model.forces(ring.shape(), position, forces);
    const SolveStatus status = ring.descend(position);
    ASSERT_TRUE(status.ok()) << position.output_angle;
    EXPECT_LE(status.residual, inserted.parameters.solver.force_tolerance);
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
    const SolveStatus status = turnTo(0.3, twist);
    ASSERT_TRUE(status.ok()) << twist;
    RingShape shape = ring.shape();
    shape.updateGeometry();
    RingForces forces(shape.teeth());
    model.forces(shape, ring.position(), forces);
    EXPECT_LE(forces.teeth.lpNorm<Eigen::Infinity>(), parameters.solver.force_tolerance);
    EXPECT_EQ(forces.energy, ring.forces().energy);
    EXPECT_EQ(forces.output_torque, ring.forces().output_torque);
    EXPECT_EQ(ring.position().output_angle, 0.3 / ratio() + twist);
  }
}

/// Also where nobody has called updateModel().
TEST_F(Ring, IsSolvedAgainOnceItsModelHasChanged)
{
  ASSERT_TRUE(turnTo(0.3, -2e-3).ok());
  const double energy = ring.forces().energy;
  model.edit<ToothMesh>().stiffness() *= 0.5;
  ASSERT_TRUE(ring.moveTo(ring.position()).ok());
  EXPECT_LT(ring.forces().energy, 0.999 * energy);
  RingEquilibrium fresh(model, parameters.solver);
  ASSERT_TRUE(fresh.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }).ok());
  ASSERT_TRUE(fresh.moveTo(ring.position()).ok());
  EXPECT_NEAR(ring.forces().energy, fresh.forces().energy, 1e-9 * energy);
  // Of a tangent at most a Newton step away (see RingEquilibrium::byWaveGenerator); that of the old model is off by
  // 2e-2.
  EXPECT_NEAR(ring.stiffness()(1, 1), fresh.stiffness()(1, 1), 1e-4 * fresh.stiffness()(1, 1));
}

TEST_F(Ring, IsTwoFoldSymmetric)
{
  ASSERT_TRUE(turnTo(0.3, -2e-3).ok());
  const int half = model.rest.teeth() / 2;
  for (int i = 0; i < half; ++i)
  {
    // Equilibrium to 5e-7 N over the softest contact in the ring, some 1e5 N/m.
    EXPECT_NEAR((ring.shape().points.segment<2>(2 * i) + ring.shape().points.segment<2>(2 * (i + half))).norm(), 0.0,
                5e-12);
    EXPECT_NEAR(ring.forces().of<ToothMesh>().flank_force[i], ring.forces().of<ToothMesh>().flank_force[i + half], 1e-4)
        << i;
    EXPECT_NEAR(ring.forces().of<WaveGeneratorContact>().force[i],
                ring.forces().of<WaveGeneratorContact>().force[i + half], 1e-4)
        << i;
  }
}

TEST_F(Ring, HasNoLeftAndRight)
{
  ASSERT_TRUE(moveTo(0.01, -2e-3).ok());
  const Eigen::VectorXd points = ring.shape().points;
  const RingForces forces = ring.forces();
  ASSERT_TRUE(moveTo(-0.01, 2e-3).ok());
  EXPECT_LT((mirrored(points) - ring.shape().points).lpNorm<Eigen::Infinity>(), 5e-12);
  EXPECT_NEAR(ring.forces().energy, forces.energy, 1e-9 * forces.energy);
  EXPECT_NEAR(ring.forces().output_torque, -forces.output_torque, 1e-6 * std::abs(forces.output_torque));
  EXPECT_NEAR(ring.forces().wave_generator_torque, -forces.wave_generator_torque,
              1e-6 * std::abs(forces.wave_generator_torque));
}

TEST_F(Ring, RepeatsEveryToothPitchReachedInSmallSteps)
{
  constexpr int STEPS = 37;
  ASSERT_TRUE(turnTo(0.1, -1.5e-3).ok());
  const Eigen::VectorXd points = ring.shape().points;
  const RingForces forces = ring.forces();
  for (int i = 1; i <= STEPS; ++i)
  {
    const double turn = pitch() * i / STEPS;
    ASSERT_TRUE(moveTo(0.1 + turn, (0.1 + turn) / ratio() - 1.5e-3).ok());
  }
  expectShifted(points, forces, ring, 1);
}

TEST_F(Ring, RepeatsEveryToothPitchReachedAtOnce)
{
  ASSERT_TRUE(turnTo(0.1, -1.5e-3).ok());
  const Eigen::VectorXd points = ring.shape().points;
  const RingForces forces = ring.forces();
  int total = 0;
  for (const int pitches : { 1, -1, 7, -30, 150 })
  {
    total += pitches;
    const double angle = 0.1 + total * pitch();
    ASSERT_TRUE(turnTo(angle, -1.5e-3).ok()) << pitches;
    expectShifted(points, forces, ring, total);
  }
}

TEST_F(Ring, GivesTheSameStateByEveryPath)
{
  ASSERT_TRUE(turnTo(0.2, -1e-3).ok());
  const Eigen::VectorXd points = ring.shape().points;
  const double energy = ring.forces().energy;
  for (const double way : { 0.25, 0.19, 0.1, -0.3 })
  {
    ASSERT_TRUE(turnTo(way, 1e-3).ok());
    ASSERT_TRUE(turnTo(0.2, -1e-3).ok());
    EXPECT_LT((points - ring.shape().points).lpNorm<Eigen::Infinity>(), 5e-12) << way;
    EXPECT_NEAR(ring.forces().energy, energy, 1e-9 * energy) << way;
  }
  RingEquilibrium cold(model, parameters.solver);
  ASSERT_TRUE(cold.insert({ 0.2, 0.2 / ratio() - 1e-3, amplitude }).ok());
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
    InsertedRing inserted(shippedParameters(errors));
    RingEquilibrium& ring = inserted.ring;
    const double ratio = nominalRatio(inserted.parameters.gear);
    SeededRandom random(58);
    Eigen::Vector2d step(0.0, 0.0);  // of the motor and of the twist [rad]
    Eigen::Vector2d turned(0.0, 0.0);
    for (int i = 0; i < STEPS; ++i)
    {
      if (i % SPELL == 0)
      {
        step = { random.uniform() * inserted.model.rest.pitchAngle(), random.uniform() * 2e-5 };
      }
      turned += step;
      ASSERT_TRUE(ring.follow({ turned[0], turned[0] / ratio + turned[1], inserted.amplitude }).ok()) << i;
      RingEquilibrium exact = ring;
      ASSERT_TRUE(exact.moveTo(ring.position()).ok());
      const double torque = TABLED * exact.stiffness()(1, 1);
      EXPECT_NEAR(ring.torques()[1], exact.torques()[1], torque) << i;
      EXPECT_NEAR(ring.torques()[0], exact.torques()[0], torque / ratio) << i;
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
  SeededRandom random(51);
  InsertedRing inserted(goldenParameters());
  const RingEquilibrium& ring = inserted.ring;
  CyclicSolver solver(inserted.model.rest.teeth());
  double angle = 0.0;
  double twist = 0.0;
  double worst = 0.0;
  for (int k = 0; k < 6000; ++k)
  {
    angle += 0.0317 * random.uniform();
    twist = 0.999 * (twist + 1e-4 * random.uniform());
    ASSERT_TRUE(inserted.moveTo(angle, angle / nominalRatio(inserted.parameters.gear) + twist).ok());
    const RingTangent tangent = wholeTangent(ring);
    ASSERT_TRUE(solver.factor(tangent));
    Eigen::VectorXd by_output = -tangent.output;
    solver.solve<1>(by_output);
    const double stiffness = tangent.output_stiffness + tangent.output.dot(by_output);
    worst = std::max(worst, std::abs(ring.stiffness()(1, 1) - stiffness) / stiffness);
  }
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
  const double start = ring.forces().energy;
  double total = 0.0;
  double throughput = 0.0;
  for (std::size_t leg = 0; leg + 1 < corners.size(); ++leg)
  {
    const double before = ring.forces().energy;
    const Eigen::Vector2d way = angles(leg, 1.0) - angles(leg, 0.0);
    double work = 0.0;
    for (int i = 0; i <= STEPS; ++i)
    {
      const Eigen::Vector2d to = angles(leg, static_cast<double>(i) / STEPS);
      ASSERT_TRUE(moveTo(to[0], to[1]).ok());
      const double power = -ring.forces().wave_generator_torque * way[0] - ring.forces().output_torque * way[1];
      const double weight = (i == 0 || i == STEPS ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) / (3.0 * STEPS);
      work += weight * power;
      throughput += weight * std::abs(power);
    }
    // Simpson's rule over torques with kinks where teeth touch.
    EXPECT_NEAR(work, ring.forces().energy - before, 1e-5 * throughput) << leg;
    total += work;
  }
  EXPECT_NEAR(total, 0.0, 1e-5 * throughput);
  EXPECT_NEAR(ring.forces().energy, start, 1e-9 * throughput);
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
  ASSERT_TRUE(turnTo(0.2, -1e-3).ok());
  const Eigen::VectorXd points = ring.shape().points;
  for (const double way : { 0.25, 0.19, 0.1, -0.3 })
  {
    ASSERT_TRUE(turnTo(way, 1e-3).ok());
    ASSERT_TRUE(turnTo(0.2, -1e-3).ok());
    EXPECT_LT((points - ring.shape().points).lpNorm<Eigen::Infinity>(), 5e-11) << way;
  }
}

TEST_P(RingOnBalls, RepeatsEveryToothPitchUnlessTheBallsAreSingle)
{
  ASSERT_TRUE(turnTo(0.1, -1.5e-3).ok());
  const Eigen::VectorXd points = ring.shape().points;
  const RingForces forces = ring.forces();
  ASSERT_TRUE(moveTo(0.1 + 7 * pitch(), (0.1 + 7 * pitch()) / ratio() - 1.5e-3).ok());
  if (GetParam() == "balls")
  {
    expectShifted(points, forces, ring, 7);
  }
  else
  {
    EXPECT_GT(std::abs(ring.forces().energy - forces.energy), 1e-6 * forces.energy);
  }
}

/// One that has dropped out of reach carries nothing, and those beside it carry more.
TEST(RingOnSingleBalls, GoesOnWithoutOneOfThem)
{
  InsertedRing inserted(shippedParameters({ "contact.support=single_balls" }));
  RingEquilibrium& ring = inserted.ring;
  ASSERT_TRUE(balanceOutput(ring, 0.0, 67.0).ok());
  const auto force = [&](int ball) { return ring.forces().of<WaveGeneratorContact>().balls[ball].force; };
  const double before = force(0);
  const double after = force(2);
  EXPECT_GT(force(1), 100.0);
  inserted.model.edit<WaveGeneratorContact>().bearing().addIdleBall(1, 0.1e-3);
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
  const auto solved = [](double fit, double torque)  // [um], [N.m]
  {
    InsertedRing inserted(
        goldenParameters({ "contact.support=single_balls", "ring.bending_stiffness=258.0",
                           "bearing.race_bending_stiffness=670.0", "contact.fit=" + std::to_string(fit) + "e-6" }));
    EXPECT_TRUE(balanceOutput(inserted.ring, 0.0, torque).ok());
    return inserted.ring.forces().of<WaveGeneratorContact>();
  };
  for (const auto& [fit, force] : { std::pair(-2.0, 475.0), std::pair(-1.0, 490.0), std::pair(0.0, 512.0),
                                    std::pair(1.0, 549.0), std::pair(2.0, 710.0), std::pair(5.0, 1687.0) })
  {
    EXPECT_NEAR(solved(fit, 5.0).force.sum(), force, 0.002 * force) << fit;
  }
  for (const auto& [torque, hardest] : { std::pair(14.0, 98.0), std::pair(67.0, 324.0), std::pair(150.0, 617.0) })
  {
    const auto contact = solved(0.0, torque);
    const auto ball = std::max_element(contact.balls.begin(), contact.balls.begin() + 23,
                                       [](const auto& a, const auto& b) { return a.force < b.force; });
    EXPECT_NEAR(ball->force, hardest, 0.005 * hardest) << torque;
  }
}

using HalfRing = testing::TestWithParam<const char*>;
INSTANTIATE_TEST_SUITE_P(Gears, HalfRing, testing::Values("shipped", "golden"));

TEST_P(HalfRing, IsTheWholeRing)
{
  constexpr double NEXT_TO_NOTHING = 1e-30;  // m, of one tooth's clearance: the halves differ, and no force does
  SeededRandom random(52);
  const Parameters parameters = std::string(GetParam()) == "golden" ? goldenParameters() : shippedParameters();
  const RingModel model(parameters);
  RingModel different(parameters);
  different.edit<ToothMesh>().clearance()[7] = NEXT_TO_NOTHING;
  ASSERT_EQ(model.solvedTeeth(), 100);
  ASSERT_EQ(different.solvedTeeth(), 200);
  const double w = parameters.gear.wave_amplitude;
  RingEquilibrium half(model, parameters.solver);
  RingEquilibrium whole(different, parameters.solver);
  ASSERT_TRUE(half.insert({ 0.0, 0.0, w }).ok() && whole.insert({ 0.0, 0.0, w }).ok());
  ASSERT_EQ(half.shape().solved, 100);
  ASSERT_EQ(whole.shape().solved, 200);
  const double rate_size = whole.byWaveGenerator().norm();
  double angle = 0.0;
  double twist = 0.0;
  for (int k = 0; k < 200; ++k)
  {
    angle += 0.03 * random.uniform();
    twist = 0.99 * twist + 2e-4 * random.uniform();
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
