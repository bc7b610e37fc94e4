// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "element_under_test.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "random_ring.hpp"
#include "solver/ring_equilibrium.hpp"
#include "studies/dynamic_runs.hpp"
#include "studies/ring_stepper.hpp"
#include "test/core/ring_dynamics_support.hpp"
#include "test/support/allocation_count.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
const std::array<const RungeKuttaTableau*, 3> TABLEAUS{ &implicitEuler(), &trBdf2(), &esdirk4() };

Eigen::MatrixXd matrixOf(const RungeKuttaTableau& tableau)
{
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(tableau.stages(), tableau.stages());
  for (int i = 0; i < tableau.stages(); ++i)
  {
    const auto& row = tableau.before[static_cast<std::size_t>(i)];
    for (std::size_t j = 0; j < row.size(); ++j)
    {
      a(i, static_cast<Eigen::Index>(j)) = row[j];
    }
    a(i, i) = i == 0 && tableau.explicit_first ? 0.0 : tableau.gamma;
  }
  return a;
}

/// What is left of the order conditions (Hairer, Norsett and Wanner, II.2) of orders 1 to 4 for weights b.
std::array<double, 4> orderDefects(const Eigen::MatrixXd& a, const Eigen::VectorXd& c, const Eigen::VectorXd& b)
{
  const Eigen::VectorXd c2 = c.cwiseAbs2();
  const double third = std::max(std::abs(b.dot(c2) - 1.0 / 3.0), std::abs(b.dot(a * c) - 1.0 / 6.0));
  const double fourth =
      std::max({ std::abs(b.dot(c2.cwiseProduct(c)) - 0.25), std::abs(b.cwiseProduct(c).dot(a * c) - 0.125),
                 std::abs(b.dot(a * c2) - 1.0 / 12.0), std::abs(b.dot(a * (a * c)) - 1.0 / 24.0) });
  return { std::abs(b.sum() - 1.0), std::abs(b.dot(c) - 0.5), third, fourth };
}

TEST(RungeKuttaTableau, HasItsOrderAndSoHasItsErrorEstimate)
{
  for (const RungeKuttaTableau* tableau : TABLEAUS)
  {
    SCOPED_TRACE("order " + std::to_string(tableau->order));
    const Eigen::MatrixXd a = matrixOf(*tableau);
    const Eigen::VectorXd c = Eigen::Map<const Eigen::VectorXd>(tableau->times.data(), tableau->stages());
    EXPECT_LT((a.rowwise().sum() - c).lpNorm<Eigen::Infinity>(), 1e-14);
    const Eigen::VectorXd b = a.bottomRows<1>().transpose();
    for (int i = 0; i < tableau->stages(); ++i)
    {
      EXPECT_EQ(b[i], tableau->weight(i));
    }
    const auto defects = orderDefects(a, c, b);
    for (int order = 1; order <= 4; ++order)
    {
      const double defect = defects[static_cast<std::size_t>(order) - 1];
      EXPECT_EQ(defect < 1e-14, order <= tableau->order) << order << ": " << defect;
    }
    if (!tableau->error.empty())
    {
      const Eigen::VectorXd embedded = b - Eigen::Map<const Eigen::VectorXd>(tableau->error.data(), tableau->stages());
      for (int order = 1; order <= 3; ++order)  // of both
      {
        EXPECT_LT(orderDefects(a, c, embedded)[static_cast<std::size_t>(order) - 1], 1e-14) << order;
      }
    }
  }
}

/// Amplification of y' = z y in a step of 1.
std::complex<double> amplification(const RungeKuttaTableau& tableau, std::complex<double> z)
{
  const Eigen::MatrixXd a = matrixOf(tableau);
  const Eigen::VectorXcd ones = Eigen::VectorXcd::Ones(a.rows());
  const Eigen::MatrixXcd system = Eigen::MatrixXcd::Identity(a.rows(), a.rows()) - z * a.cast<std::complex<double>>();
  const Eigen::VectorXcd stages = system.partialPivLu().solve(ones);
  return stages[a.rows() - 1];
}

TEST(RungeKuttaTableau, IsLStable)
{
  for (const RungeKuttaTableau* tableau : TABLEAUS)
  {
    for (double frequency = 1e-3; frequency < 1e6; frequency *= 1.1)
    {
      EXPECT_LE(std::abs(amplification(*tableau, { 0.0, frequency })), 1.0 + 1e-13) << frequency;
    }
    EXPECT_LT(std::abs(amplification(*tableau, { -1e9, 0.0 })), 1e-6);
  }
}

/// Dashpots strong enough to be seen beside the springs.
const std::vector<std::string> STRONG_DASHPOTS{ "ring.tension_damping=2000.0",   "ring.tooth_damping=300.0",
                                                "contact.damping=1000.0",        "output.viscous_friction=2.0",
                                                "motor.viscous_friction=1.0e-3", "output.gravity_torque=12.0" };

/// A meshed random ring, moving.
struct RandomMotion
{
  RandomMotion(Bench& bench, unsigned seed) : random(seed), motion(bench.ring->coordinates())
  {
    RingShape shape(bench.ring->teeth());
    DrivePosition position;
    random.draw(bench.model.ring, shape, position);
    bench.ring->setSpaces(shape.space);
    bench.ring->setWave({ 0.0, position.wave_amplitude, 0.05 });
    motion.q << shape.points, position.wave_generator_angle, position.output_angle;
    for (Eigen::Index k = 0; k < motion.v.size(); ++k)
    {
      motion.v[k] = random.uniform(-1.0, 1.0);
    }
  }

  RandomRing random;
  RingMotion motion;
};

Eigen::MatrixXd denseOver(const RingTangent& tangent)
{
  const Eigen::Index n = 2 * tangent.teeth();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n + 2, n + 2);
  dense.topLeftCorner(n, n) = denseTangent(tangent);
  dense.col(n).head(n) = tangent.wave_generator;
  dense.row(n).head(n) = tangent.wave_generator.transpose();
  dense.col(n + 1).head(n) = tangent.output;
  dense.row(n + 1).head(n) = tangent.output.transpose();
  dense(n, n) = tangent.wave_generator_stiffness;
  dense(n + 1, n + 1) = tangent.output_stiffness;
  return dense;
}

/// Central differences of the force, minus their sign, by the coordinates or by the speeds.
Eigen::MatrixXd differences(DynamicRing& ring, RingMotion motion, bool by_speed)
{
  const int n = ring.coordinates();
  Eigen::MatrixXd result(n, n);
  Eigen::VectorXd& varied = by_speed ? motion.v : motion.q;
  for (int k = 0; k < n; ++k)
  {
    const double step = by_speed ? 1e-2 : k < n - 2 ? 2e-9 : 1e-7;
    const double middle = varied[k];
    varied[k] = middle + step;
    const double upper = varied[k];
    ring.evaluate(motion.q, motion.v, motion.time);
    const Eigen::VectorXd after = ring.force();
    varied[k] = middle - step;
    const double width = upper - varied[k];
    ring.evaluate(motion.q, motion.v, motion.time);
    varied[k] = middle;
    result.col(k) = (ring.force() - after) / width;
  }
  ring.evaluate(motion.q, motion.v, motion.time);
  return result;
}

TEST(DynamicRing, TangentIsTheDerivativeOfTheForce)
{
  // At rest, where the turning of the dashpots' directions changes nothing; see DynamicRing::tangent.
  Bench bench(shippedParameters(STRONG_DASHPOTS));
  RandomMotion random(bench, 3);
  random.motion.v.setZero();
  bench.ring->setWave({ 0.0, bench.parameters.gear.wave_amplitude, 0.0 });
  RingTangent stiffness(bench.ring->teeth());
  RingTangent both(bench.ring->teeth());
  const Eigen::MatrixXd numeric = differences(*bench.ring, random.motion, false);
  bench.ring->tangent(0.0, stiffness);
  EXPECT_LT(relativeError(denseOver(stiffness), numeric), DIFFERENCE_TOLERANCE);
  // Torques by angles are small beside forces by positions.
  EXPECT_LT(relativeError(denseOver(stiffness).bottomRows<2>(), numeric.bottomRows<2>()), 1e-5);
  const Eigen::MatrixXd damping = differences(*bench.ring, random.motion, true);
  bench.ring->tangent(1.0, both);
  EXPECT_LT(relativeError(denseOver(both) - denseOver(stiffness), damping), 1e-5);
  EXPECT_LT(relativeError((denseOver(both) - denseOver(stiffness)).bottomRows<2>(), damping.bottomRows<2>()), 1e-5);
}

TEST(DynamicRing, JacobianIsThatOfTheRates)
{
  Bench bench(shippedParameters(STRONG_DASHPOTS));
  DynamicRing& ring = *bench.ring;
  RandomMotion random(bench, 5);
  random.motion.v.setZero();
  ring.setWave({ 0.0, bench.parameters.gear.wave_amplitude, 0.0 });
  const int n = ring.coordinates();
  const Eigen::MatrixXd by_q = differences(ring, random.motion, false);
  const Eigen::MatrixXd by_v = differences(ring, random.motion, true);
  const Eigen::MatrixXd jacobian = ring.jacobian(DynamicRing::Cup::DENSE);
  EXPECT_EQ(jacobian.topLeftCorner(n, n), Eigen::MatrixXd::Zero(n, n));
  EXPECT_EQ(jacobian.topRightCorner(n, n), Eigen::MatrixXd::Identity(n, n));
  const auto mass = ring.mass().asDiagonal();
  EXPECT_LT(relativeError(-(mass * jacobian.bottomLeftCorner(n, n)), by_q), DIFFERENCE_TOLERANCE);
  EXPECT_LT(relativeError(-(mass * jacobian.bottomRightCorner(n, n)), by_v), 1e-5);

  // Without the cup it is sparse, and the rank-one matrix makes up the difference.
  const Eigen::SparseMatrix<double> sparse = ring.jacobian(DynamicRing::Cup::LEFT_OUT);
  EXPECT_LT(sparse.nonZeros(), 100 * ring.teeth());
  RingTangent tangent(ring.teeth());
  ring.tangent(0.0, tangent);
  const Eigen::VectorXd& d = tangent.cup_direction;
  Eigen::MatrixXd completed(sparse);
  completed.block(n, 0, n - 2, n - 2) -=
      ring.inverseMass().head(n - 2).asDiagonal() * (tangent.cup_stiffness * d * d.transpose());
  EXPECT_LT((completed - jacobian).lpNorm<Eigen::Infinity>(), 1e-12 * jacobian.lpNorm<Eigen::Infinity>());
}

TEST(DynamicRing, RatesAreSpeedsAndForcesOverMasses)
{
  RingDrive drive;
  drive.wave_generator_driven = true;
  drive.load_torque = 30.0;
  Bench bench(shippedParameters(), drive);
  DynamicRing& ring = *bench.ring;
  RandomMotion random(bench, 7);
  const int n = ring.coordinates();
  std::vector<double> state(static_cast<std::size_t>(ring.states()));
  std::vector<double> rates(state.size());
  Eigen::Map<Eigen::VectorXd>(state.data(), n) = random.motion.q;
  Eigen::Map<Eigen::VectorXd>(state.data() + n, n) = random.motion.v;
  ring.rates(state.data(), 0.0, rates.data());
  const Eigen::Map<const Eigen::VectorXd> accelerations(rates.data() + n, n);
  EXPECT_EQ(Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(rates.data(), n)), random.motion.v);
  EXPECT_EQ(accelerations[ring.waveGenerator()], 0.0);
  const double tooth_mass = bench.parameters.ring.mass / ring.teeth();
  EXPECT_NEAR(accelerations[6] * tooth_mass, ring.force()[6], 1e-12 * std::abs(ring.force()[6]));
  const double inertia = bench.model.load.inertia();
  EXPECT_NEAR(accelerations[ring.output()] * inertia, ring.forces().output_torque - 30.0, 1e-9);
}

/// Power of all forces at the state = rate of stored energy lost, for a random moving state.
TEST(DynamicRing, PowerBalances)
{
  std::vector<std::string> set = STRONG_DASHPOTS;
  set.emplace_back("manufacture.wave_generator_ellipticity=2.0e-5");
  set.emplace_back("manufacture.wave_generator_eccentricity=[1.0e-5, -2.0e-5]");
  for (const bool driven : { false, true })
  {
    RingDrive drive;
    drive.motor_torque = 0.7;
    drive.load_torque = 40.0;
    drive.wave_generator_driven = driven;
    Bench bench(shippedParameters(set), drive);
    DynamicRing& ring = *bench.ring;
    RandomMotion random(bench, 11);
    const double dt = 1e-9;
    const auto stored = [&](double time)
    {
      ring.evaluate(random.motion.q + time * random.motion.v, random.motion.v, time);
      return ring.storedEnergy();
    };
    const double storing = (stored(dt) - stored(-dt)) / (2.0 * dt);
    ring.evaluate(random.motion.q, random.motion.v, 0.0);
    const Eigen::VectorXd accelerations = ring.force().cwiseProduct(ring.inverseMass());
    const double accelerating = random.motion.v.cwiseProduct(ring.mass()).dot(accelerations);
    const double scale = std::abs(storing) + std::abs(accelerating);
    EXPECT_NEAR(ring.power().supplied, storing + accelerating + ring.power().dissipated, 1e-6 * scale);
    EXPECT_GT(ring.power().dissipated, 1e-4 * scale);  // seen by the test
  }
}

TEST(BorderedRingSolver, AgreesWithADenseSolver)
{
  Bench bench(shippedParameters(STRONG_DASHPOTS));
  DynamicRing& ring = *bench.ring;
  RandomMotion random(bench, 13);
  ring.evaluate(random.motion.q, random.motion.v, 0.0);
  for (const double g : { 1e-7, 1e-5, 1e-3 })
  {
    RingTangent tangent(ring.teeth());
    ring.tangent(1.0 / g, tangent);
    for (int i = 0; i < tangent.teeth(); ++i)
    {
      tangent.addDiagonal(i, Block2((ring.mass().segment<2>(2 * i) / (g * g)).asDiagonal()));
    }
    tangent.wave_generator_stiffness += ring.mass()[ring.waveGenerator()] / (g * g);
    tangent.output_stiffness += ring.mass()[ring.output()] / (g * g);
    const Eigen::VectorXd load = random.motion.v;
    for (const std::array<bool, 2> held : { std::array<bool, 2>{ false, false }, { true, false }, { true, true } })
    {
      Eigen::MatrixXd dense = denseOver(tangent);
      Eigen::VectorXd right = load;
      for (int k = 0; k < 2; ++k)
      {
        const Eigen::Index row = ring.waveGenerator() + k;
        if (held[static_cast<std::size_t>(k)])
        {
          dense.row(row).setZero();
          dense.col(row).setZero();
          dense(row, row) = 1.0;
          right[row] = 0.0;
        }
      }
      BorderedRingSolver solver(ring.teeth());
      ASSERT_TRUE(solver.factor(tangent, held));
      Eigen::VectorXd x = load;
      solver.solve(x);
      const Eigen::PartialPivLU<Eigen::MatrixXd> lu(dense);
      const Eigen::VectorXd expected = lu.solve(right);
      // Backward: what is left over, in roundings of the terms that should cancel; a row that is held has none.
      const Eigen::VectorXd terms = (dense.cwiseAbs() * x.cwiseAbs() + right.cwiseAbs()).cwiseMax(1e-300);
      EXPECT_LT(((dense * x - right).cwiseQuotient(terms)).lpNorm<Eigen::Infinity>(), 1e-11) << g;
      EXPECT_LT((x - expected).norm(), 1e-6 * expected.norm()) << g;
    }
  }
}
}  // namespace
}  // namespace hjt
