// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "element_under_test.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "random_ring.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/inertia_error.hpp"
#include "studies/dynamic_runs.hpp"
#include "studies/ring_stepper.hpp"
#include "test/core/ring_dynamics_support.hpp"
#include "test/support/allocation_count.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
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
    for (int k = 0; k < steps; ++k)
    {
      EXPECT_TRUE(stepper.step(motion, duration / steps));
    }
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
  for (int k = 0; k < 10000; ++k)
  {
    ASSERT_TRUE(stepper->step(motion, 1e-7));
  }
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
    for (int k = 0; k < 50; ++k)
    {
      ASSERT_TRUE(stepper->step(motion, step));
    }
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
    for (int k = 0; k < 10; ++k)
    {
      EXPECT_TRUE(stepper->step(motion, 1e-6));
    }
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
