// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <complex>
#include <limits>
#include <memory>

#include <Eigen/LU>

#include "statics/inertia_error.hpp"
#include "studies/dynamic_runs.hpp"
#include "studies/ring_stepper.hpp"
#include "test/core/element_under_test.hpp"
#include "test/core/random_ring.hpp"
#include "test/core/test_parameters.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
/// A dynamic ring with what it needs.
struct Bench
{
  explicit Bench(const Parameters& parameters, const RingDrive& drive = {}, bool meshed = true)
    : parameters(parameters), model(parameters), drive(drive)
  {
    model.ring.setMeshed(meshed);
    ring = std::make_unique<DynamicRing>(model, parameters.ring, drive);
  }

  Parameters parameters;
  JointModel model;
  RingDrive drive;
  std::unique_ptr<DynamicRing> ring;
};

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
    const auto [shape, position] = random.draw(bench.model.ring);
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

void march(RingStepper& stepper, RingMotion& motion, double step, int steps)
{
  for (int k = 0; k < steps; ++k)
  {
    ASSERT_TRUE(stepper.step(motion, step)) << k;
  }
}

/// A ring of few soft teeth, so that all its modes can be resolved; free of the wave generator, and swinging.
struct SoftRing : Bench
{
  SoftRing()
    : Bench(goldenParameters({ "gear.teeth_flexspline=16", "gear.teeth_circular_spline=18",
                               "ring.tension_stiffness=1.0e+6", "ring.bending_stiffness=4.0", "ring.tooth_damping=0.2",
                               "solver.force_tolerance=1.0e-9" }),
            held(), false)
    , start(ring->coordinates())
  {
    model.ring.edit<WaveGeneratorContact>().stiffness().setZero();
    start.q.head(2 * ring->teeth()) = model.ring.rest.points();
    for (int i = 0; i < ring->teeth(); ++i)
    {
      const double psi = i * model.ring.rest.pitchAngle();
      start.v[2 * i] = 2.0 * std::cos(2.0 * psi) * std::cos(psi) + std::cos(3.0 * psi);
      start.v[2 * i + 1] = 2.0 * std::cos(2.0 * psi) * std::sin(psi);
    }
  }

  static RingDrive held()
  {
    RingDrive drive;
    drive.wave_generator_driven = true;
    drive.output_driven = true;
    return drive;
  }

  RingMotion after(RingMethod method, double duration, int steps)
  {
    return after(*makeRingStepper(method, *ring, parameters.solver), duration, steps);
  }

  RingMotion after(RingStepper& stepper, double duration, int steps)
  {
    RingMotion motion = start;
    march(stepper, motion, duration / steps, steps);
    ring->evaluate(motion.q, motion.v, motion.time);
    return motion;
  }

  RingMotion start;
};

TEST(QuasiStaticCheck, ComparesEveryQuantityOfARingThatFollows)
{
  const Parameters parameters = shippedParameters();
  QuasiStaticSetup setup;
  setup.settle_time = 1e-4;
  setup.duration = 2e-4;
  const QuasiStaticResult result = checkQuasiStatic(parameters, setup, [](double) {});
  ASSERT_EQ(result.outcome, QuasiStaticOutcome::DONE);
  EXPECT_EQ(result.rows.size(), 6U) << "every 37 us";
  for (const DynamicError& error : { result.contact_force, result.mesh_force, result.position,
                                     result.wave_generator_torque, result.output_torque, result.torsion })
  {
    EXPECT_GT(error.rms, 0.0);
    EXPECT_GE(error.max, error.rms);
    EXPECT_GT(error.size, error.rms);
  }
  // Radially w cos 2a, along the rim half of that: root mean square of a coordinate, to leading order.
  EXPECT_NEAR(result.position.size / parameters.gear.wave_amplitude, std::sqrt(5.0 / 16.0), 0.05);
}

TEST(RingStepper, ConvergesWithItsOrder)
{
  constexpr double DURATION = 4e-4;
  struct Case
  {
    RingMethod method;
    int steps;
    double order;
  };
  SoftRing bench;
  const RingMotion reference = bench.after(RingMethod::RUNGE_KUTTA4, DURATION, 3200);
  for (const Case& test : { Case{ RingMethod::RUNGE_KUTTA4, 50, 4.0 }, Case{ RingMethod::IMPLICIT_EULER, 800, 1.0 },
                            Case{ RingMethod::TR_BDF2, 200, 2.0 }, Case{ RingMethod::ESDIRK4, 50, 4.0 } })
  {
    const double coarse = (bench.after(test.method, DURATION, test.steps).q - reference.q).norm();
    const double fine = (bench.after(test.method, DURATION, 2 * test.steps).q - reference.q).norm();
    EXPECT_NEAR(std::log2(coarse / fine), test.order, 0.0625 * test.order)
        << static_cast<int>(test.method) << " " << coarse;
    EXPECT_LT(fine, 0.2 * (reference.q - bench.start.q).norm());
  }
}

TEST(RingStepper, ErrorEstimateFallsWithThePowerOfItsLocalError)
{
  SoftRing bench;
  for (const RungeKuttaTableau* tableau : { &trBdf2(), &esdirk4() })
  {
    std::array<double, 2> estimate{};
    for (int k = 0; k < 2; ++k)
    {
      RingMotion motion = bench.after(RingMethod::RUNGE_KUTTA4, 1e-4, 500);
      ImplicitRingStepper stepper(*bench.ring, *tableau, bench.parameters.solver);
      ASSERT_TRUE(stepper.step(motion, k == 0 ? 8e-6 : 4e-6));
      estimate[static_cast<std::size_t>(k)] = stepper.errorEstimate();
    }
    // The less accurate of the two methods it compares is of order 2 or 3: one power more.
    EXPECT_NEAR(std::log2(estimate[0] / estimate[1]), tableau->order == 2 ? 3.0 : 4.0, 0.4);
  }
}

double lost(const DynamicRing& ring, const RingMotion& motion, double stored_at_start, double kinetic_at_start)
{
  return motion.supplied - motion.dissipated - (ring.storedEnergy() - stored_at_start) -
         (ring.kineticEnergy(motion.v) - kinetic_at_start);
}

TEST(RingStepper, EnergyBalancesButForWhatTheMethodDamps)
{
  constexpr double DURATION = 1e-3;
  SoftRing bench;
  bench.ring->evaluate(bench.start.q, bench.start.v, 0.0);
  const double stored = bench.ring->storedEnergy();
  const double kinetic = bench.ring->kineticEnergy(bench.start.v);
  const auto loss_of = [&](RingMethod method, int steps)
  {
    const RingMotion motion = bench.after(method, DURATION, steps);
    EXPECT_GT(motion.dissipated, 0.01 * kinetic);
    return lost(*bench.ring, motion, stored, kinetic) / kinetic;
  };
  EXPECT_LT(std::abs(loss_of(RingMethod::RUNGE_KUTTA4, 4000)), 1e-7);
  EXPECT_LT(std::abs(loss_of(RingMethod::ESDIRK4, 1000)), 1e-5);
  EXPECT_GT(loss_of(RingMethod::IMPLICIT_EULER, 1000), 0.05);  // its own damping
}

TEST(RingStepper, EnergyBalancesWhileTheWaveGrows)
{
  const Parameters parameters = thesisParameters({ "contact.law=normal" });
  for (const auto& [method, step] :
       { std::pair{ RingMethod::RUNGE_KUTTA4, 5e-7 }, std::pair{ RingMethod::ESDIRK4, 1e-6 } })
  {
    const TransientSetup setup{ method, step, 2e-3, 1e-3, 1e-3, 1e-4 };
    const TransientResult result = analyseTransient(parameters, setup, [](double) {});
    ASSERT_TRUE(result.finished);
    const TransientRow& end = result.rows.back();
    EXPECT_NEAR(end.supplied - end.dissipated - end.stored - end.kinetic, 0.0, 2e-6 * end.supplied)
        << static_cast<int>(method);
  }
}

/// The working drive: energy of a driven wave generator and a load, teeth coming and going.
TEST(RingStepper, EnergyBalancesInTheWorkingDrive)
{
  RingDrive drive;
  drive.wave_generator_driven = true;
  drive.load_torque = 50.0;
  const Parameters parameters = shippedParameters();
  drive.wave.amplitude = parameters.gear.wave_amplitude;
  Bench bench(parameters, drive);
  RingEquilibrium equilibrium(bench.model.ring, parameters.solver);
  ASSERT_TRUE(equilibrium.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }).ok());
  ASSERT_TRUE(balanceOutput(equilibrium, 0.0, drive.load_torque).ok());
  DynamicRing& ring = *bench.ring;
  ring.setSpaces(equilibrium.shape().space);
  RingMotion motion(ring.coordinates());
  motion.q << equilibrium.shape().points, 0.0, equilibrium.position().output_angle;
  motion.v[ring.waveGenerator()] = 60.0;  // all at once: the ring is struck
  ring.evaluate(motion.q, motion.v, 0.0);
  const double stored = ring.storedEnergy();
  const double kinetic = ring.kineticEnergy(motion.v);
  const auto stepper = makeRingStepper(RingMethod::RUNGE_KUTTA4, ring, parameters.solver);
  march(*stepper, motion, 1e-7, 10000);
  ring.evaluate(motion.q, motion.v, motion.time);
  EXPECT_NEAR(lost(ring, motion, stored, kinetic), 0.0, 2e-4 * std::abs(motion.supplied));
  EXPECT_EQ(motion.v[ring.waveGenerator()], 60.0);
  EXPECT_NEAR(motion.q[ring.waveGenerator()], 0.06, 1e-12);
}

TEST(RingStepper, AnEquilibriumStays)
{
  const Parameters parameters = shippedParameters({ "solver.force_tolerance=1.0e-6" });
  RingDrive drive;
  drive.wave.amplitude = parameters.gear.wave_amplitude;
  drive.load_torque = 48.0;
  Bench probe(parameters, drive);
  RingEquilibrium equilibrium(probe.model.ring, parameters.solver);
  ASSERT_TRUE(equilibrium.insert({ 0.1, 0.1 / 101.0, parameters.gear.wave_amplitude }).ok());
  ASSERT_TRUE(balanceOutput(equilibrium, 0.1, drive.load_torque).ok());
  drive.motor_torque = -equilibrium.forces().wave_generator_torque;  // what holds the wave generator
  for (const auto& [method, step] :
       { std::pair{ RingMethod::RUNGE_KUTTA4, 2e-7 }, std::pair{ RingMethod::IMPLICIT_EULER, 1e-4 },
         std::pair{ RingMethod::TR_BDF2, 1e-4 }, std::pair{ RingMethod::ESDIRK4, 1e-4 } })
  {
    Bench bench(parameters, drive);
    bench.ring->setSpaces(equilibrium.shape().space);
    RingMotion motion(bench.ring->coordinates());
    motion.q << equilibrium.shape().points, 0.1, equilibrium.position().output_angle;
    const RingMotion start = motion;
    const auto stepper = makeRingStepper(method, *bench.ring, parameters.solver);
    march(*stepper, motion, step, 50);
    // Forces are balanced to 1e-6 N or N.m a coordinate: a tooth against 1e8 N/m, a free angle accelerates.
    EXPECT_LT((motion.q - start.q).head(2 * bench.ring->teeth()).lpNorm<Eigen::Infinity>(), 1e-9);
    EXPECT_LT((motion.q - start.q).tail<2>().lpNorm<Eigen::Infinity>(), 1e-7);
  }
}

TEST(RingStepper, AFailedStepLeavesTheMotion)
{
  SoftRing bench;
  for (const auto& [method, tolerance] :
       { std::pair{ RingMethod::RUNGE_KUTTA4, 0.0 }, std::pair{ RingMethod::ESDIRK4, 0.0 },
         std::pair{ RingMethod::ESDIRK4, 1e-6 } })
  {
    RingMotion motion = bench.start;
    motion.v[3] = std::numeric_limits<double>::quiet_NaN();
    const auto stepper = makeRingStepper(method, *bench.ring, bench.parameters.solver, tolerance);
    EXPECT_FALSE(stepper->step(motion, 1e-5));
    EXPECT_EQ(motion.q, bench.start.q);
    EXPECT_EQ(motion.time, 0.0);
    if (method == RingMethod::ESDIRK4 && tolerance == 0.0)
    {
      EXPECT_EQ(stepper->counts().halvings, bench.parameters.solver.max_step_cuts + 1);
    }
  }
}

TEST(AdaptiveRingStepper, ErrorFollowsTheTolerance)
{
  constexpr double DURATION = 4e-4;
  SoftRing bench;
  const RingMotion reference = bench.after(RingMethod::RUNGE_KUTTA4, DURATION, 3200);
  constexpr double LOOSEST = 1e-6;
  for (const RingMethod method : { RingMethod::TR_BDF2, RingMethod::ESDIRK4 })
  {
    long steps = 0;
    double looser = 1.0;
    for (const double tolerance : { LOOSEST, 1e-2 * LOOSEST, 1e-4 * LOOSEST })
    {
      SCOPED_TRACE(std::to_string(static_cast<int>(method)) + ", tolerance " + std::to_string(1e9 * tolerance) + " nm");
      const auto stepper = makeRingStepper(method, *bench.ring, bench.parameters.solver, tolerance);
      const RingMotion motion = bench.after(*stepper, DURATION, 2);
      EXPECT_NEAR(motion.time, DURATION, 1e-18);
      // Of all steps together; the modes keep what single steps leave.
      const double error = (motion.q - reference.q).lpNorm<Eigen::Infinity>();
      EXPECT_LT(error, 0.5 * tolerance * static_cast<double>(stepper->counts().steps));
      EXPECT_LT(error, 0.1 * looser);
      looser = error;
      EXPECT_GT(stepper->counts().steps, steps);
      steps = stepper->counts().steps;
    }
  }
}

TEST(AdaptiveRingStepper, ShrinksItsStepWhereTheRingIsStruckAndTakesBackWhatWasTooLong)
{
  const Parameters parameters = thesisParameters({ "contact.law=normal" });
  // At rest, and then a wave that grows: nothing announces the stroke.
  TransientSetup setup{ RingMethod::ESDIRK4, 5e-4, 6e-3, 5e-3, 5e-3, 1e-3, 1e-7 };
  const TransientResult result = analyseTransient(parameters, setup, [](double) {});
  ASSERT_TRUE(result.finished);
  EXPECT_GT(result.counts.rejections, 0);
  EXPECT_LT(result.counts.rejections, result.counts.steps / 4);
  EXPECT_GT(result.counts.steps, 12);
}

TEST(RingStepper, AStepTooLongIsHalved)
{
  // The working ring struck at 3 m/s: one iteration is not enough for a long step, but is for shorter ones.
  Parameters parameters = thesisParameters({ "contact.law=normal", "solver.max_iterations=4" });
  TransientSetup setup{ RingMethod::TR_BDF2, 2e-4, 2e-3, 1e-3, 1e-3, 1e-4 };
  const TransientResult result = analyseTransient(parameters, setup, [](double) {});
  EXPECT_TRUE(result.finished);
  EXPECT_GT(result.counts.halvings, 0);
  EXPECT_EQ(result.counts.steps, 10);
}

TEST(RingStepper, AllocatesNothing)
{
  const Parameters parameters = thesisParameters();
  RingDrive drive;
  drive.wave = { 0.0, 0.0, 0.07 };
  for (const auto& [method, tolerance] :
       { std::pair{ RingMethod::RUNGE_KUTTA4, 0.0 }, std::pair{ RingMethod::TR_BDF2, 0.0 },
         std::pair{ RingMethod::ESDIRK4, 0.0 }, std::pair{ RingMethod::ESDIRK4, 1e-9 } })
  {
    Bench bench(parameters, drive);
    RingMotion motion(bench.ring->coordinates());
    motion.q.head(2 * bench.ring->teeth()) = bench.model.ring.rest.points();
    const auto stepper = makeRingStepper(method, *bench.ring, parameters.solver, tolerance);
    const std::size_t before = allocationCount();
    march(*stepper, motion, 1e-6, 10);
    EXPECT_EQ(allocationCount(), before) << static_cast<int>(method);
  }
}

TransientResult insertionTransient(RingMethod method, double step)
{
  const TransientSetup setup{ method, step, 0.05, 5e-3, 0.03, 5e-4 };
  return analyseTransient(thesisParameters(), setup, [](double) {});
}

TEST(InsertionTransient, DoesNotSettleAndSwingsAlikeByTheStructuredMethod)
{
  const TransientResult result = insertionTransient(RingMethod::RUNGE_KUTTA4, 1e-6);
  ASSERT_TRUE(result.finished);
  double lowest = 1e9;
  double highest = 0.0;
  double sum = 0.0;
  int rows = 0;
  for (const TransientRow& row : result.rows)
  {
    if (row.time >= 0.03 - 1e-9)
    {
      lowest = std::min(lowest, row.force_max);
      highest = std::max(highest, row.force_max);
      sum += row.force_max;
      ++rows;
    }
  }
  // A prototype's figures, looked at every half millisecond: 460 ... 632 N about 545 N.
  EXPECT_NEAR(lowest, 460.0, 3.0);
  EXPECT_NEAR(highest, 632.0, 3.0);
  EXPECT_NEAR(sum / rows, 545.0, 1.0);

  const TransientResult structured = insertionTransient(RingMethod::ESDIRK4, 5e-6);
  ASSERT_TRUE(structured.finished);
  EXPECT_NEAR(structured.window_lowest, result.window_lowest, 0.02 * result.window_lowest);
  EXPECT_NEAR(structured.window_highest, result.window_highest, 0.02 * result.window_highest);
  EXPECT_LT(structured.counts.force_evaluations, result.counts.force_evaluations);
}

TEST(ExpectedMeshForceError, IsThatOfInertiaInSimilarGears)
{
  const Parameters gear = shippedParameters();
  const double error = expectedMeshForceError(gear.ring, gear.gear, 200.0, 80.0);
  EXPECT_GT(error, 0.0);
  EXPECT_EQ(expectedMeshForceError(gear.ring, gear.gear, 0.0, 80.0), 0.0);
  EXPECT_EQ(expectedMeshForceError(gear.ring, gear.gear, -200.0, -80.0), error);
  EXPECT_NEAR(expectedMeshForceError(gear.ring, gear.gear, 300.0, 80.0), 2.25 * error, 1e-12);
  // Half as long, of the same material: an eighth of mass and torque, twice the speed, a quarter of all forces.
  Parameters half = gear;
  half.gear.flexspline_inner_radius *= 0.5;
  half.ring.mass *= 0.125;
  EXPECT_NEAR(expectedMeshForceError(half.ring, half.gear, 400.0, 10.0), 0.25 * error, 1e-12);
}
}  // namespace
}  // namespace hjt
