// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <limits>
#include <optional>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "statics/static_solver.hpp"
#include "test/core/ring_fixture.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
void expectFinite(const RingEquilibrium& ring)
{
  EXPECT_TRUE(ring.shape().points.allFinite());
  EXPECT_TRUE(allFinite(ring.forces()));
  EXPECT_TRUE(ring.byWaveGenerator().allFinite() && ring.byOutput().allFinite() && ring.stiffness().allFinite());
  EXPECT_TRUE(std::isfinite(ring.position().wave_generator_angle) && std::isfinite(ring.position().output_angle));
}

/// The ring is in equilibrium at the position it names, with the forces it names.
void expectEquilibrium(const RingEquilibrium& ring, double tolerance)
{
  RingForces forces(ring.shape().teeth());
  ring.model().forces(ring.shape(), ring.position(), forces);
  EXPECT_LE(forces.teeth.lpNorm<Eigen::Infinity>(), tolerance);
  EXPECT_TRUE(forces.teeth == ring.forces().teeth);
  EXPECT_EQ(forces.energy, ring.forces().energy);
}

using Assignments = std::vector<std::string>;

void expectInsertedOrSaid(const Assignments& assignments, bool must_converge)
{
  SCOPED_TRACE(testing::PrintToString(assignments));
  const Parameters parameters = goldenParameters(assignments);
  const RingModel model(parameters);
  RingEquilibrium ring(model, parameters.solver);
  const SolveStatus status = ring.insert({ 0.1, 0.0, parameters.gear.wave_amplitude });
  expectFinite(ring);
  expectEquilibrium(ring, parameters.solver.force_tolerance);
  if (must_converge)
  {
    EXPECT_EQ(status.code, SolveCode::CONVERGED);
  }
  if (status.ok())
  {
    EXPECT_LE(status.residual, parameters.solver.force_tolerance);
    EXPECT_EQ(ring.position().wave_amplitude, parameters.gear.wave_amplitude);
  }
  else
  {
    EXPECT_TRUE(status.code == SolveCode::NO_DESCENT || status.code == SolveCode::ITERATION_LIMIT);
    EXPECT_EQ(status.stage, SolveStage::INSERTION);
    EXPECT_LT(ring.position().wave_amplitude, parameters.gear.wave_amplitude);
  }
}

std::string times(const std::string& key, double value, double factor)
{
  char text[100];
  std::snprintf(text, sizeof(text), "%s=%.1f", key.c_str(), value * factor);
  return text;
}

using StiffenedRing = testing::TestWithParam<double>;
INSTANTIATE_TEST_SUITE_P(Factor, StiffenedRing, testing::Values(10.0, 100.0));

TEST_P(StiffenedRing, IsInsertedOrSaysThatItIsNot)
{
  const double factor = GetParam();
  const std::string tension = times("ring.tension_stiffness", 5e9, factor);
  const std::string bending = times("ring.bending_stiffness", 400.0, factor);
  const std::string contact = times("contact.stiffness", 1e8, factor);
  const std::string mesh = times("mesh.stiffness", 5e7, factor);
  expectInsertedOrSaid({ tension }, true);
  expectInsertedOrSaid({ bending }, true);
  expectInsertedOrSaid({ mesh }, true);
  expectInsertedOrSaid({ contact }, true);
  expectInsertedOrSaid({ tension, bending, contact, mesh }, true);
}

/// Without the circular spline, as statics solve it.
SolveStatus insertAlone(const Assignments& assignments, double tolerance = 5e-7)
{
  Parameters parameters = goldenParameters(assignments);
  parameters.solver.force_tolerance = tolerance;
  RingModel model(parameters);
  model.setMeshed(false);
  RingEquilibrium ring(model, parameters.solver);
  const SolveStatus status = ring.insert({ 0.1, 0.0, parameters.gear.wave_amplitude });
  expectFinite(ring);
  return status;
}

TEST(RingAlone, IsInsertedHoweverSoftOrStiff)
{
  // Here Newton's method alone gives up: teeth touch and let go by the dozen.
  for (const Assignments& assignments :
       std::vector<Assignments>{ { "ring.bending_stiffness=200.0" },
                                 { "ring.bending_stiffness=40.0" },
                                 { "ring.bending_stiffness=0.4" },
                                 { "contact.stiffness=1.0e+10" },
                                 { "contact.stiffness=1.0e+10", "ring.bending_stiffness=4.0" },
                                 { "ring.bending_stiffness=300.0", "gear.wave_amplitude=0.089e-3" } })
  {
    SCOPED_TRACE(testing::PrintToString(assignments));
    const SolveStatus status = insertAlone(assignments);
    EXPECT_TRUE(status.ok());
    EXPECT_LE(status.residual, 5e-7);
  }
}

TEST(RingAlone, IsSolvedToItsOwnRounding)
{
  // A coordinate's last digit times the stiffness is more than these tolerances; asking for them must not fail.
  EXPECT_TRUE(insertAlone({ "ring.bending_stiffness=4.0e+4" }).ok());
  EXPECT_TRUE(insertAlone({ "ring.tension_stiffness=5.0e+11" }).ok());
  EXPECT_TRUE(insertAlone({ "gear.teeth_flexspline=4000", "gear.teeth_circular_spline=4002" }).ok());
  const SolveStatus status = insertAlone({}, 1e-9);
  EXPECT_TRUE(status.ok());
  EXPECT_LT(status.residual, 2e-7);
}

TEST(UnusualRing, IsInsertedOrSaysThatItIsNot)
{
  for (const bool absolute : { false, true })
  {
    const std::string law = absolute ? "ring.bending_law=absolute" : "ring.bending_law=curvature";
    expectInsertedOrSaid({ law, "gear.wave_amplitude=0.7e-3" }, true);
    expectInsertedOrSaid({ law, "contact.law=polar" }, true);
    expectInsertedOrSaid({ law, "mesh.smoothing=1.0e-6", "contact.smoothing=1.0e-6" }, true);
  }
  expectInsertedOrSaid({ "ring.bending_stiffness=0.0" }, false);
  expectInsertedOrSaid({ "mesh.stiffness=0.0" }, true);
  expectInsertedOrSaid({ "mesh.flank_clearance=50.0e-6" }, true);
  expectInsertedOrSaid({ "mesh.flank_clearance=-200.0e-6" }, false);
}

using RingOfTeeth = testing::TestWithParam<int>;
INSTANTIATE_TEST_SUITE_P(Number, RingOfTeeth, testing::Values(8, 10, 12, 20, 50, 100, 160, 198, 202, 240, 320, 400));

TEST_P(RingOfTeeth, IsInsertedOrSaysThatItIsNot)
{
  // The other sizes of the shipped gear fit about 200 teeth only; far from that the teeth stand in each other's way.
  const int teeth = GetParam();
  expectInsertedOrSaid(
      { "gear.teeth_flexspline=" + std::to_string(teeth), "gear.teeth_circular_spline=" + std::to_string(teeth + 2) },
      teeth >= 160 && teeth <= 240);
}

/// All that a ring shows, to be compared bit by bit.
struct Snapshot
{
  explicit Snapshot(const RingEquilibrium& ring)
    : position(ring.position())
    , shape(ring.shape())
    , forces(ring.forces())
    , by_wave_generator(ring.byWaveGenerator())
    , by_output(ring.byOutput())
    , stiffness(ring.stiffness())
  {
  }

  void expectSame(const RingEquilibrium& ring) const
  {
    EXPECT_EQ(position.wave_generator_angle, ring.position().wave_generator_angle);
    EXPECT_EQ(position.output_angle, ring.position().output_angle);
    EXPECT_EQ(position.wave_amplitude, ring.position().wave_amplitude);
    EXPECT_TRUE(shape.points == ring.shape().points);
    EXPECT_TRUE(shape.lengths == ring.shape().lengths);
    EXPECT_TRUE(shape.directions == ring.shape().directions);
    EXPECT_TRUE(shape.space == ring.shape().space);
    EXPECT_TRUE(forces.teeth == ring.forces().teeth);
    EXPECT_TRUE(forces.of<WaveGeneratorContact>().force == ring.forces().of<WaveGeneratorContact>().force);
    EXPECT_TRUE(forces.of<ToothMesh>().flank_force == ring.forces().of<ToothMesh>().flank_force);
    EXPECT_EQ(forces.wave_generator_torque, ring.forces().wave_generator_torque);
    EXPECT_EQ(forces.output_torque, ring.forces().output_torque);
    EXPECT_EQ(forces.energy, ring.forces().energy);
    EXPECT_TRUE(by_wave_generator == ring.byWaveGenerator());
    EXPECT_TRUE(by_output == ring.byOutput());
    EXPECT_TRUE(stiffness == ring.stiffness());
  }

  DrivePosition position;
  RingShape shape;
  RingForces forces;
  Eigen::VectorXd by_wave_generator;
  Eigen::VectorXd by_output;
  Eigen::Matrix2d stiffness;
};

TEST(FailedMove, LeavesTheLastGoodStateToTheLastBit)
{
  constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();
  constexpr double ENDLESS = std::numeric_limits<double>::infinity();
  InsertedRing inserted(shippedParameters());
  RingEquilibrium& ring = inserted.ring;
  const double w = inserted.amplitude;
  ASSERT_TRUE(inserted.moveTo(0.02, -1e-3).ok());
  const Snapshot good(ring);
  for (const DrivePosition& absurd :
       { DrivePosition{ NOT_A_NUMBER, 0.0, w }, DrivePosition{ 0.0, NOT_A_NUMBER, w },
         DrivePosition{ 0.0, 0.0, NOT_A_NUMBER }, DrivePosition{ ENDLESS, 0.0, w }, DrivePosition{ 0.0, -ENDLESS, w },
         DrivePosition{ 0.02, 1e300, w }, DrivePosition{ 1e300, 0.0, w }, DrivePosition{ 0.02, 1e6, w },
         DrivePosition{ 1.02, -1e6, w } })
  {
    SCOPED_TRACE(testing::PrintToString(absurd.wave_generator_angle) + " " +
                 testing::PrintToString(absurd.output_angle));
    EXPECT_FALSE(ring.moveTo(absurd).ok());
    good.expectSame(ring);
  }
  // And it goes on from there as if nothing had been.
  InsertedRing other(inserted.parameters);
  ASSERT_TRUE(other.moveTo(0.02, -1e-3).ok() && other.moveTo(0.03, -2e-3).ok());
  ASSERT_TRUE(inserted.moveTo(0.03, -2e-3).ok());
  Snapshot(other.ring).expectSame(ring);
}

TEST(FailedMove, ThatGotHalfWayLeavesAnEquilibriumToo)
{
  // Just as many iterations as the insertion needs: large moves then fail, some of them after a part of the way.
  Parameters parameters = shippedParameters();
  const double w = parameters.gear.wave_amplitude;
  const RingModel model(parameters);
  parameters.solver.max_iterations = 0;
  parameters.solver.max_step_cuts = 3;
  std::optional<RingEquilibrium> ring;
  do
  {
    ++parameters.solver.max_iterations;
    ring.emplace(model, parameters.solver);
  } while (!ring->insert({ 0.0, 0.0, w }).ok());
  int failures = 0;
  for (int k = 1; k <= 40; ++k)
  {
    const DrivePosition start = ring->position();
    const DrivePosition target{ 0.37 * k, 0.37 * k / 101.0 + (k % 2 == 0 ? 1.0 : -1.0) * 2e-3 * k, w };
    const SolveStatus status = ring->moveTo(target);
    expectFinite(*ring);
    expectEquilibrium(*ring, parameters.solver.force_tolerance);
    if (!status.ok())
    {
      ++failures;
      // The caller's own state is the start of the move: the ring must not have gone off without it.
      EXPECT_EQ(ring->position().wave_generator_angle, start.wave_generator_angle);
      EXPECT_EQ(ring->position().output_angle, start.output_angle);
    }
  }
  EXPECT_GT(failures, 3);
}

/// 592 N.m on a gear with pitch errors; found as its table was built.
TEST(FailedMove, IsReachedByDescent)
{
  const Parameters parameters = shippedParameters(
      { "manufacture.circular_spline_pitch_deviation=9.884e-6", "manufacture.circular_spline_pitch_seed=5900" },
      { "joints/shoulder" });
  const RingModel model(parameters);
  RingEquilibrium ring(model, staticSolver(parameters.solver));
  const double pitch = model.rest.pitchAngle();
  const double amplitude = parameters.gear.wave_amplitude;
  const auto at = [&](double pitches, double twist) -> DrivePosition {
    return { pitches * pitch, twist + pitches * pitch / nominalRatio(parameters.gear), amplitude };
  };
  constexpr double TWIST = -0.010368091;
  ASSERT_TRUE(ring.insert(at(0.0, 0.0)).ok());
  for (int piece = 1; piece <= 40; ++piece)
  {
    ASSERT_TRUE(ring.moveTo(at(0.0, TWIST * piece / 40)).ok());
  }
  int failed = 0;
  for (int place = 0; place >= -16 * 68; --place)
  {
    const DrivePosition next = at(place / 16.0, TWIST);
    const SolveStatus status = ring.moveTo(next);
    if (!status.ok())
    {
      ++failed;
      ASSERT_TRUE(ring.reach(next).ok());
    }
    expectEquilibrium(ring, staticSolver(parameters.solver).force_tolerance);
  }
  EXPECT_GT(failed, 0);
}

TEST(FaultyTooth, OfNotANumberIsSaidAndDoesNotSpread)
{
  const Parameters parameters = shippedParameters();
  for (const int tooth : { 0, 1, 2, 3, 57, 198, 199 })
  {
    RingModel model(parameters);
    model.edit<WaveGeneratorContact>().stiffness()[tooth] = std::numeric_limits<double>::quiet_NaN();
    RingEquilibrium ring(model, parameters.solver);
    EXPECT_FALSE(ring.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }).ok()) << tooth;
    EXPECT_TRUE(ring.shape().points.allFinite()) << tooth;
  }
}

TEST(FaultyTooth, LeavesARingThatStillTurns)
{
  const Parameters parameters = shippedParameters();
  const double w = parameters.gear.wave_amplitude;
  RingModel model(parameters);
  model.edit<ToothMesh>().stiffness()[4] = 0.0;     // broken off
  model.edit<RimBending>().stiffness()[40] *= 0.2;  // cracked rim
  model.edit<RimTension>().stiffness()[40] *= 0.2;
  model.edit<ToothMesh>().clearance()[90] = 5e-6;  // worn
  RingEquilibrium ring(model, parameters.solver);
  ASSERT_TRUE(ring.insert({ 0.0, 0.0, w }).ok());
  for (int k = 1; k <= 300; ++k)
  {
    ASSERT_TRUE(ring.moveTo({ 0.03 * k, 0.03 * k / 101.0 - 1.5e-3, w }).ok()) << k;
    ASSERT_EQ(ring.forces().of<ToothMesh>().flank_force[4], 0.0);
    expectEquilibrium(ring, parameters.solver.force_tolerance);
  }
}

TEST(PairedAtRest, IsEveryToothWithItsNearestSpaceHoweverDeepItStands)
{
  // A circular spline of smaller tip radius stands between the teeth of the flexspline before it is deformed.
  for (const std::string tip : { "31.95e-3", "31.9e-3", "31.8e-3" })
  {
    const Parameters parameters = shippedParameters({ "gear.tip_radius_circular_spline=" + tip });
    const RingModel model(parameters);
    for (const double angle : { 0.0, 0.01, 2.0 })
    {
      const RingShape shape = model.restShape({ 0.0, angle, 0.0 });
      for (int i = 0; i < shape.teeth(); ++i)
      {
        const double space = TWO_PI / parameters.gear.teeth_circular_spline;
        const double off = std::remainder(i * model.rest.pitchAngle() - angle - shape.space[i] * space, TWO_PI);
        ASSERT_LE(std::abs(off), 0.5 * space * (1.0 + 1e-9)) << "tooth " << i << " tip " << tip;
      }
    }
  }
}

TEST(Backlash, IsCrossedByTheStaticAnalysesAtAnyAngle)
{
  // With clearance no tooth touches when the output is free: there is no stiffness to go by until one does.
  const Parameters parameters = shippedParameters({ "mesh.flank_clearance=20.0e-6" });
  for (const double angle : { 0.0, 0.3 })
  {
    const std::vector<StiffnessRow> rows = analyseStiffness(parameters, angle, { 5.0, -5.0, 48.0 });
    ASSERT_TRUE(rows[0].status.ok() && rows[1].status.ok() && rows[2].status.ok()) << angle;
    EXPECT_LT(rows[0].output_angle, -0.3e-3);
    EXPECT_GT(rows[1].output_angle - rows[0].output_angle, 2.0 * 20e-6 / 32e-3);
  }
}

TEST(Overload, MakesTheTeethOfASoftGearJump)
{
  // Flat flanks on a rim that gives way: under the circular spline turned on by three of its pitches the teeth climb
  // out, and find the next space.
  InsertedRing inserted(goldenParameters({ "contact.stiffness=1.0e+6", "ring.tension_stiffness=5.0e+7",
                                           "mesh.flank_angle=1.0", "mesh.engagement_depth=200.0e-6" }));
  const double space = TWO_PI / inserted.parameters.gear.teeth_circular_spline;
  const RingEquilibrium& ring = inserted.ring;
  const int first = ring.shape().space[0];
  double highest = 0.0;
  double last = 0.0;
  int drops = 0;
  for (int k = 1; k <= 900; ++k)
  {
    // At the instant of the jump there is no equilibrium near; the next step finds one beyond it.
    const bool found = inserted.moveTo(0.0, -k * 1e-4).ok();
    expectFinite(ring);
    expectEquilibrium(ring, inserted.parameters.solver.force_tolerance);
    const double torque = ring.forces().output_torque;
    drops += found && torque < 0.5 * last ? 1 : 0;
    highest = std::max(highest, torque);
    last = torque;
  }
  EXPECT_GT(drops, 0);
  // It holds some torque before it jumps, and less than a tenth of what teeth that never jump would have built up.
  EXPECT_GT(highest, 50.0);
  EXPECT_LT(highest, 0.1 * 31e3 * 0.09);
  EXPECT_GT(ring.shape().space[0], first) << "a tooth stands " << 0.09 / space << " spaces behind";
}
}  // namespace
}  // namespace hjt
