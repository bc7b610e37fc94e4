// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <cstddef>
#include <memory>

#include <gmock/gmock.h>

#include "params/field_table.hpp"
#include "surface/deviation_rings.hpp"
#include "surface/parallel_tasks.hpp"
#include "surface/surface_builder.hpp"
#include "surface/surface_ring.hpp"
#include "test/core/response_surface_support.hpp"

namespace hjt
{
namespace
{
void expectSame(const DeviationTable& one, const DeviationTable& other)
{
  ASSERT_EQ(one.pitches.size(), 100U);  // half a turn
  ASSERT_EQ(other.pitches.size(), 100U);
  for (std::size_t i = 0; i < one.pitches.size(); ++i)
  {
    EXPECT_EQ(one.pitches[i].lines, other.pitches[i].lines) << i;
    EXPECT_TRUE(one.pitches[i].nodes == other.pitches[i].nodes) << i;
  }
}

/// One table serves for all teeth.
TEST(SurfaceDeviations, OfOneToothAreThoseOfAnotherTurned)
{
  const Parameters parameters = surfaceParameters();
  std::vector<SurfacePool::Surface> surfaces;
  int built = 0;
  for (const char* fault : { "tooth_root_crack:1:0", BROKEN_TOOTH, "tooth_root_crack:1:199" })
  {
    surfaces.push_back(surfaceWithFaults(parameters, faultsOf({ fault }),
                                         { cacheDirectory(), [&](double done) { built += done >= 1.0 ? 1 : 0; }, {} }));
    ASSERT_TRUE(surfaces.back());
    built = surfaces.size() == 1 ? 0 : built;
  }
  EXPECT_EQ(built, 0);
  const ResponseSurface direct(surface().table(), brokenTables().deviations);
  for (double motor = -7.0; motor < 7.0; motor += 0.0137)
  {
    const double output = motor / 101.0 + 1.3e-3;
    const ResponseSurface::Place here = placeOn(*surfaces[1], motor, output);
    const ResponseSurface::Place there = placeOn(direct, motor, output);
    // Two rings, each solved to rounding at other angles.
    EXPECT_NEAR(surfaces[1]->response(here).output_torque, direct.response(there).output_torque, 2e-4);
    const double force = ResponseSurface::lobeForces(there)[0];
    EXPECT_NEAR(ResponseSurface::lobeForces(here)[0], force, 0.005 * force);
  }
}

/// Energy and torques are continuous where the tables of two pitches meet, whatever lines they have.
TEST(SurfaceDeviations, AreContinuousFromPitchToPitch)
{
  const SurfaceTables tables = brokenTables();
  const ResponseSurface faulty(tables.table, tables.deviations);
  constexpr double BESIDE = 1e-12;  // rad
  const double pitch = TWO_PI / 200;
  for (int edge = -50; edge < 250; ++edge)
  {
    for (double v = -4e-3; v < 4e-3; v += 1.3e-4)
    {
      const double motor = edge * pitch;
      const RingResponse before = at(motor - BESIDE, v + motor / 101.0, faulty);
      const RingResponse after = at(motor + BESIDE, v + motor / 101.0, faulty);
      EXPECT_NEAR(before.energy, after.energy, 1e-9);
      EXPECT_NEAR(before.output_torque, after.output_torque, 1e-5);
      EXPECT_NEAR(before.wave_generator_torque, after.wave_generator_torque, 1e-6);
    }
  }
}

/// A place taken from a pitch with deviations to one without any has none.
TEST(SurfaceDeviations, AreNotKeptInAPlaceThatMovesOn)
{
  SurfaceTables tables = brokenTables();
  for (std::size_t pitch = 1; pitch < tables.deviations.pitches.size(); pitch += 2)
  {
    tables.deviations.pitches[pitch] = {};
  }
  const ResponseSurface faulty(tables.table, tables.deviations);
  ResponseSurface::Place moving;
  for (int pitch = 0; pitch < 100; ++pitch)
  {
    const double motor = (pitch + 0.37) * TWO_PI / 200;
    ASSERT_TRUE(faulty.locate(motor, 2e-3 + motor / 101.0, moving));
    EXPECT_EQ(faulty.response(moving).energy, at(motor, 2e-3 + motor / 101.0, faulty).energy) << pitch;
  }
}

/// A broken tooth looks the same from both sides: one half is measured, and the other is what it would have been.
TEST(SurfaceDeviations, AreMeasuredOneWayWhereTheOtherIsTheirMirrorImage)
{
  const Parameters parameters = surfaceParameters();
  const auto built = [&](double highest)
  { return buildDeviations(parameters, JointModel(parameters), brokenModel(), 100, surface().lowest(), highest, {}); };
  const DeviationBuild mirrored = built(surface().highest());
  const DeviationBuild measured = built(surface().highest() * (1.0 + 1e-12));
  EXPECT_LT(mirrored.solves, 0.6 * measured.solves);
  const ResponseSurface one(surface().table(), mirrored.table);
  const ResponseSurface other(surface().table(), measured.table);
  SeededRandom random(7);
  Eigen::Array2d misses(0.0, 0.0);  // of output torque [N.m] and of a lobe's force [N], squares
  Eigen::Array2d sizes(0.0, 0.0);   // of the fault's effect on them
  for (int i = 0; i < 20000; ++i)
  {
    const double motor = 20.0 * (random.uniform(0.0, 1.0) - 0.5);
    const double output = motor / 101.0 - 4e-3 * random.uniform(0.0, 1.0);
    const auto of = [&](const ResponseSurface& which)
    {
      const ResponseSurface::Place place = placeOn(which, motor, output);
      return Eigen::Array2d(which.response(place).output_torque, ResponseSurface::lobeForces(place)[0]);
    };
    misses += (of(one) - of(other)).square();
    sizes += (of(other) - of(surface())).square();
  }
  // Either may miss the ring's torque by 0.5 % of the largest effect, by which the table is refined. Forces are not
  // among what refines it: a bound that a table of the other side's sign or place would exceed by far.
  EXPECT_LT(std::sqrt(misses[0] / sizes[0]), 5e-3);
  EXPECT_LT(std::sqrt(misses[1] / sizes[1]), 5e-2);
}

TEST(DeviationRings, MeasureTheGearAtThePitchAndTheColumnThatAreAskedFor)
{
  constexpr int COLUMNS = 4;
  constexpr double V = -1e-3;         // [rad]
  constexpr double TOLERANCE = 2e-4;  // of two rings, each solved to rounding [N.m]
  const Parameters parameters = surfaceParameters();
  DeviationRings rings(parameters, JointModel(parameters), brokenModel());
  SurfaceRing alone(parameters, brokenModel());
  ASSERT_TRUE(rings.insert() && alone.insert() && rings.leadTo(V, 1e-4));
  const Strip equal = rings.measureEqual(COLUMNS);
  ASSERT_EQ(equal.size(), static_cast<std::size_t>(COLUMNS));
  double effect = 0.0;
  for (std::size_t pitch = 0; pitch < 60; pitch += 3)  // the broken tooth is the one of pitch 40
  {
    for (std::size_t column = 0; column < equal.size(); ++column)
    {
      SurfaceNode node;
      ASSERT_TRUE(rings.measureActual(pitch, column, node));
      const double part = static_cast<double>(column) / COLUMNS;
      ASSERT_TRUE(alone.moveTo((static_cast<double>(pitch) + part) * alone.pitch(), V));
      constexpr auto TORQUE = SurfaceNode::ENERGY_BY_V;  // on the output, less its sign
      EXPECT_NEAR(node[TORQUE], alone.measure()[TORQUE], TOLERANCE) << pitch << ' ' << column;
      effect = std::max(effect, std::abs(node[TORQUE] - equal[column][TORQUE]));
    }
  }
  EXPECT_GT(effect, 100.0 * TOLERANCE);  // of another place
}

/// What is small beside the surface's own tolerance is tabulated less finely, not left out.
TEST(SurfaceDeviations, OfASmallFaultTakeNoMoreNodesThanOfALargeOne)
{
  const Parameters parameters = surfaceParameters();
  int solves = 0;
  for (const char* fault : { BROKEN_TOOTH, "pitting:0.1:40" })
  {
    const JointModel model = JointFaults(parameters, faultsOf({ fault })).model();
    const DeviationBuild build =
        buildDeviations(parameters, JointModel(parameters), model, 100, surface().lowest(), surface().highest(), {});
    ASSERT_TRUE(build.failure_reason.empty()) << build.failure_reason;
    solves = solves == 0 ? build.solves : solves;
    EXPECT_LT(build.solves, 1.5 * solves) << fault;
    const ResponseSurface faulty(surface().table(), build.table);
    SurfaceRing with(parameters, model);
    SurfaceRing without(parameters, JointModel(parameters));
    ASSERT_TRUE(with.insert() && without.insert());
    double effect = 0.0;
    double miss = 0.0;
    for (double v = 0.0; v > -1.6e-3; v -= 4e-6)  // as under up to 60 N.m, over two turns of the wave generator
    {
      const double motor = -v * TWO_PI / 7.3e-4;
      ASSERT_TRUE(with.moveTo(motor, v) && without.moveTo(motor, v));
      const double deviation = without.measure()[SurfaceNode::ENERGY_BY_V] - with.measure()[SurfaceNode::ENERGY_BY_V];
      const double tabled =
          at(motor, v + motor / 101.0, faulty).output_torque - at(motor, v + motor / 101.0).output_torque;
      effect += std::pow(deviation, 2);
      miss += std::pow(tabled - deviation, 2);
    }
    EXPECT_GT(effect, 0.0) << fault;
    // 1.5 % of the largest on a line, which is about three times the root mean square.
    EXPECT_LT(std::sqrt(miss / effect), 0.045) << fault;
  }
}

TEST(SurfaceDeviations, AreNotBuiltBeyondABoundedNumberOfPoints)
{
  constexpr std::size_t MOST = 20000;
  const Parameters parameters = surfaceParameters();
  const DeviationBuild build = buildDeviations(parameters, JointModel(parameters), brokenModel(), 100,
                                               surface().lowest(), surface().highest(), {}, MOST);
  EXPECT_THAT(build.failure_reason, testing::HasSubstr("more than 20000 points"));
  EXPECT_THAT(build.failure_reason, testing::HasSubstr("gear.teeth_flexspline = 200"));
  EXPECT_THAT(build.failure_reason, testing::HasSubstr("output.load_torque_limit = 284"));
  EXPECT_TRUE(build.table.pitches.empty());
}

TEST(SurfaceDeviations, BitsDoNotDependOnTheNumberOfThreads)
{
  const Parameters parameters = surfaceParameters();
  const auto built = [&](unsigned threads)
  {
    return buildDeviations(parameters, JointModel(parameters), brokenModel(), 100, -1e-5, 2e-5, {},
                           MAX_DEVIATION_POINTS, threads)
        .table;
  };
  const DeviationTable one = built(1);
  expectSame(one, built(3));
  EXPECT_TRUE(
      std::any_of(one.pitches.begin(), one.pitches.end(), [](const auto& pitch) { return !pitch.nodes.empty(); }));
}

/// Sets every number that no table depends on to another one within its range.
struct SetOthers
{
  template <class Number>
  void operator()(const std::string& /*key*/, const char* /*unit*/, Number& value, const Range& range,
                  const Meaning& meaning) const
  {
    if (meaning.shapes == Shapes::OTHERS)
    {
      const double half = 0.5 * static_cast<double>(value);
      value = static_cast<Number>(half == 0.0 ? std::min(1.0, range.max) : std::max(half, range.min));
    }
  }

  template <std::size_t N>
  void operator()(const std::string& /*key*/, const char* /*unit*/, std::array<double, N>& /*value*/,
                  const Range& /*range*/, const Meaning& /*meaning*/) const
  {
  }

  template <class Value>
  void operator()(const std::string& /*key*/, Value& /*value*/, const Meaning& /*meaning*/) const
  {
  }
};

TEST(SurfaceDeviations, DependOnNoNumberThatTheKeyOfTheirFileDoesNotHold)
{
  const Parameters shipped = surfaceParameters();
  Parameters others = shipped;
  visitFields(others, SetOthers());
  others.solver.max_iterations = 2;
  ASSERT_EQ(describeSurfaceParameters(shipped, true), describeSurfaceParameters(others, true));
  ASSERT_NE(shipped.motor.rotor_inertia, others.motor.rotor_inertia);
  const auto built = [](const Parameters& parameters)
  {
    FaultList faults;
    faults.set(parseFault(BROKEN_TOOTH, parameters), 0);
    return buildDeviations(parameters, JointModel(parameters), JointFaults(parameters, faults).model(), 100, -1e-5,
                           2e-5, {}, MAX_DEVIATION_POINTS, processors())
        .table;
  };
  expectSame(built(shipped), built(others));
}

/// Where a tooth begins to touch no grid is fine enough: how often that is stands in the table, and is said.
TEST(SurfaceDeviations, TellHowOftenTheyMissTheirTolerance)
{
  const TemporaryFolder folder;
  std::string said;
  const SurfaceSource source{ folder.path().string(), {}, [&](const std::string& what) { said += what + '\n'; } };
  const SurfaceTables built = brokenTables(source);
  const GridChecks& checks = built.deviations.checks;
  EXPECT_GT(checks.made, 1000);
  EXPECT_GT(checks.missed, 0);
  EXPECT_LT(checks.missed, 0.02 * checks.made);
  EXPECT_THAT(said, testing::HasSubstr("teeth that differ: " + std::to_string(checks.missed) + " of " +
                                       std::to_string(checks.made) + " checks between its nodes miss the tolerance"));
  EXPECT_LT(built.table.checks.worst, 5.0);
  EXPECT_THAT(said, testing::Not(testing::HasSubstr("response surface: ")));
}

TEST(SurfaceDeviations, ComeFromTheCacheAsTheyWereBuilt)
{
  const SurfaceTables built = brokenTables();
  bool building = false;
  const SurfaceTables kept = brokenTables({ cacheDirectory(), [&](double) { building = true; }, {} });
  EXPECT_FALSE(building);
  EXPECT_EQ(built.deviations.checks.missed, kept.deviations.checks.missed);
  EXPECT_EQ(built.table.teeth.checks.worst, kept.table.teeth.checks.worst);
  expectSame(built.deviations, kept.deviations);
}

/// A ball that has dropped does in a gear with a broken tooth nearly what it does in one without.
TEST(SurfaceBalls, AddUpWithABrokenTooth)
{
  const Parameters parameters = surfaceParameters();
  const FaultList tooth = faultsOf({ BROKEN_TOOTH });
  const FaultList both = faultsOf({ BROKEN_TOOTH, "bearing_cage:1:3" });
  const SurfacePool::Surface with = surfaceWithFaults(parameters, both, cached());
  const SurfacePool::Surface without = surfaceWithFaults(parameters, tooth, cached());
  ASSERT_TRUE(with && without);
  EXPECT_FALSE(with->deviations().pitches.empty());
  SurfaceRing ring_without(parameters, JointFaults(parameters, tooth).model());
  SurfaceRing ring_with(parameters, JointFaults(parameters, both).model());
  SeededRandom random(4);
  for (const double load : { -60.0, 60.0 })
  {
    ASSERT_TRUE(ring_without.insert() && ring_with.insert());
    double squares = 0.0;
    double miss_squares = 0.0;
    double motor = 0.0;
    for (int i = 0; i < 400; ++i)
    {
      motor += ring_with.pitch() * random.uniform(0.0, 1.0);
      const double v = ring_with.twist(load) * (0.9 + 0.1 * random.uniform(0.0, 1.0));
      ASSERT_TRUE(ring_without.moveTo(motor, v) && ring_with.moveTo(motor, v));

      const double effect =
          ring_without.measure()[SurfaceNode::ENERGY_BY_V] - ring_with.measure()[SurfaceNode::ENERGY_BY_V];
      const double tabled =
          at(motor, v + motor / 101.0, *with).output_torque - at(motor, v + motor / 101.0, *without).output_torque;
      squares += effect * effect;
      miss_squares += std::pow(tabled - effect, 2);
    }
    EXPECT_LT(std::sqrt(miss_squares / squares), 0.03) << load;
  }
}

/// The gear with faults, and its surface.
struct FaultyGear
{
  explicit FaultyGear(const std::vector<std::string>& texts) : faults(faultsOf(texts)) {}

  RingResponse at(double motor_angle, double output_angle) const
  {
    return hjt::at(motor_angle, output_angle, *surface);
  }

  Parameters parameters = surfaceParameters();
  FaultList faults;
  JointModel model = JointFaults(parameters, faults).model();
  SurfacePool::Surface surface = surfaceWithFaults(parameters, faults, cached());
};

TEST(SurfaceBalls, TorquesAndStiffnessAreTheEnergysDerivatives)
{
  constexpr double STEP = 1e-7;
  for (const char* fault : { "bearing_ball:1:4", "bearing_cage:0.6:3" })
  {
    const FaultyGear gear({ fault });
    ASSERT_TRUE(gear.surface);
    SeededRandom random(5);
    for (int i = 0; i < 2000; ++i)
    {
      const double motor = 10.0 * random.uniform();
      const double output = motor / 101.0 + 5e-3 * random.uniform();
      const RingResponse here = gear.at(motor, output);
      const RingResponse before = gear.at(motor - STEP, output);
      const RingResponse after = gear.at(motor + STEP, output);
      const double by_output =
          (gear.at(motor, output + STEP).energy - gear.at(motor, output - STEP).energy) / (2.0 * STEP);
      EXPECT_NEAR(here.wave_generator_torque, -(after.energy - before.energy) / (2.0 * STEP), 2e-6);
      EXPECT_NEAR(here.output_torque, -by_output, 2e-4);
      const double stiffness = (before.wave_generator_torque - after.wave_generator_torque) / (2.0 * STEP);
      EXPECT_NEAR(here.motor_stiffness, stiffness, 1e-3 * std::abs(stiffness) + 1e-4);
    }
    // Within a cell; at its edges the tables' curvature jumps.
    for (const double motor : { 0.31, 1.71, 4.07 })
    {
      const double output = motor / 101.0 + 1.234e-3;
      const auto torque = [&](double angle) { return gear.at(angle, output).wave_generator_torque; };
      const double stiffness = gear.at(motor, output).motor_stiffness;
      EXPECT_NEAR(stiffness, (torque(motor - STEP) - torque(motor + STEP)) / (2.0 * STEP), 1e-4 * std::abs(stiffness));
    }
  }
}

/// A fault, and how much of what it changes its surface may miss, root mean square.
struct FeltFault
{
  const char* name;
  std::string fault;
  double stride;               // of the motor, mostly where it is felt [tooth pitches]
  double output_miss;          // [-]
  double wave_generator_miss;  // [-]
};

using SurfaceOfAFault = testing::TestWithParam<FeltFault>;
INSTANTIATE_TEST_SUITE_P(All, SurfaceOfAFault,
                         testing::Values(FeltFault{ "tooth", BROKEN_TOOTH, 0.6, 0.01, 0.02 },
                                         FeltFault{ "inner", "bearing_inner_race:0.7:10", 1.0, 0.08, 0.05 },
                                         FeltFault{ "outer", "bearing_outer_race:1:17", 1.0, 0.08, 0.05 },
                                         FeltFault{ "ball", "bearing_ball:0.4:4", 1.0, 0.08, 0.05 },
                                         FeltFault{ "cage", "bearing_cage:1:3", 1.0, 0.08, 0.05 }),
                         [](const auto& row) { return std::string(row.param.name); });

TEST_P(SurfaceOfAFault, IsFeltAsOnTheFullRing)
{
  const FeltFault& felt = GetParam();
  const FaultyGear without({});
  const FaultyGear with({ felt.fault });
  ASSERT_TRUE(without.surface && with.surface);
  SurfaceRing ring_without(without.parameters, without.model);
  SurfaceRing ring_with(with.parameters, with.model);
  const RaceDeflection& bearing = with.model.ring.of<WaveGeneratorContact>().bearing();
  SeededRandom random(8);
  for (const double load : { -100.0, -20.0, 20.0, 100.0 })
  {
    ASSERT_TRUE(ring_without.insert() && ring_with.insert());
    Eigen::Array2d squares = Eigen::Array2d::Zero();
    Eigen::Array2d miss_squares = Eigen::Array2d::Zero();
    double motor = 0.0;
    for (int i = 0; i < 400; ++i)
    {
      motor += felt.stride * ring_with.pitch() * random.uniform(0.0, 1.0);
      const double v = ring_with.twist(load) * (0.9 + 0.1 * random.uniform(0.0, 1.0));
      ASSERT_TRUE(ring_without.moveTo(motor, v) && ring_with.moveTo(motor, v));
      const RingResponse sound = without.at(motor, v + motor / 101.0);
      const RingResponse faulty = with.at(motor, v + motor / 101.0);
      const Eigen::Array2d tabled(faulty.output_torque - sound.output_torque,
                                  faulty.wave_generator_torque - sound.wave_generator_torque);
      bool dropped = felt.fault == BROKEN_TOOTH;
      for (int ball = 0; ball < bearing.balls(); ++ball)
      {
        dropped = dropped || bearing.drop(ball, motor).value > 0.0;
      }
      if (!dropped)
      {
        EXPECT_TRUE((tabled == 0.0).all());
        continue;
      }
      const SurfaceNode sound_node = ring_without.measure();
      const SurfaceNode faulty_node = ring_with.measure();
      const double by_v = faulty_node[SurfaceNode::ENERGY_BY_V] - sound_node[SurfaceNode::ENERGY_BY_V];
      const double by_u = faulty_node[SurfaceNode::ENERGY_BY_U] - sound_node[SurfaceNode::ENERGY_BY_U];
      const Eigen::Array2d effect(-by_v, by_v / 101.0 - by_u / ring_with.pitch());
      squares += effect.square();
      miss_squares += (tabled - effect).square();
    }
    EXPECT_GT(squares[0], 0.0);
    EXPECT_LT(std::sqrt(miss_squares[0] / squares[0]), felt.output_miss) << load;
    EXPECT_LT(std::sqrt(miss_squares[1] / squares[1]), felt.wave_generator_miss) << load;
  }
}

TEST(SurfaceBalls, BitsDoNotDependOnTheNumberOfThreads)
{
  const Parameters parameters = surfaceParameters();
  const SurfacePool::Surface surface_of_balls = sharedBallSurface(parameters, JointModel(parameters), "", cached());
  ASSERT_TRUE(surface_of_balls);
  const std::shared_ptr<const BallTable>& kept = surface_of_balls->balls()->table();
  const BallTable one =
      buildBallTable(parameters, JointModel(parameters), kept->deepest, surface().lowest(), surface().highest(), {}, 1)
          .table;
  ASSERT_EQ(one.coefficients.size(), kept->coefficients.size());
  for (std::size_t i = 0; i < one.coefficients.size(); ++i)
  {
    ASSERT_TRUE((one.coefficients[i] == kept->coefficients[i]).all()) << i;
  }
}

/// Of the twins of one process, those whose balls may drop by another depth have another table.
TEST(SurfaceBalls, ArePooledByTheirDepth)
{
  Parameters parameters = surfaceParameters();
  SurfaceSource source = cached();
  source.pool = std::make_shared<SurfacePool>(2);
  const SurfacePool::Surface first = sharedBallSurface(parameters, JointModel(parameters), "", source);
  ASSERT_TRUE(first);
  EXPECT_EQ(sharedBallSurface(parameters, JointModel(parameters), "", source), first);
  EXPECT_EQ(first->balls()->table()->deepest, parameters.fault_scale.cage_deflection);
  parameters.fault_scale.cage_deflection *= 1.1;
  source.progress = [](double) { throw std::runtime_error("a table is built"); };
  EXPECT_THROW(sharedBallSurface(parameters, JointModel(parameters), "", source), std::runtime_error);
}

TEST(SurfaceBalls, AreNotThereForSeveralFaultsOrUnequalTeeth)
{
  const Parameters parameters = surfaceParameters();
  std::string notice;
  SurfaceSource source = cached();
  source.notice = [&](const std::string& what) { notice = what; };
  const auto made = [&](const std::vector<std::string>& faults)
  { return surfaceWithFaults(parameters, faultsOf(faults), source); };
  EXPECT_FALSE(made({ "bearing_cage:1:3", "bearing_ball:1:4" }));
  EXPECT_THAT(notice, testing::HasSubstr("more than one fault of the bearing"));
  EXPECT_TRUE(made({ "bearing_cage:1:3", "bearing_ball:1:4", "bearing_ball:0:4" }));
  EXPECT_FALSE(made({ "bearing_cage:1:3", "flexspline_crack:1:40" }));
  EXPECT_THAT(notice, testing::HasSubstr("teeth differ"));
}
}  // namespace
}  // namespace hjt
