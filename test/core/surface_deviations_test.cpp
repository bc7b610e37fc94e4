// SPDX-License-Identifier: BSD-3-Clause
#include "solver/response_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "model/faults/joint_faults.hpp"
#include "model/joint_model.hpp"
#include "params/field_table.hpp"
#include "surface/deviation_rings.hpp"
#include "surface/faulty_surface.hpp"
#include "surface/parallel_tasks.hpp"
#include "surface/surface_builder.hpp"
#include "surface/surface_cache.hpp"
#include "surface/surface_ring.hpp"
#include "test/core/response_surface_support.hpp"

namespace hjt
{
namespace
{
/// One table serves for all teeth.
TEST(SurfaceDeviations, OfOneToothAreThoseOfAnotherTurned)
{
  const Parameters parameters = surfaceParameters();
  std::vector<SurfacePool::Surface> surfaces;
  int built = 0;
  for (const char* fault : { "tooth_root_crack:1:0", BROKEN_TOOTH, "tooth_root_crack:1:199" })
  {
    FaultList faults;
    faults.set(parseFault(fault, parameters), 0);
    surfaces.push_back(surfaceWithFaults(parameters, faults,
                                         { cacheDirectory(), [&](double done) { built += done >= 1.0 ? 1 : 0; }, {} }));
    ASSERT_TRUE(surfaces.back());
    built = surfaces.size() == 1 ? 0 : built;
  }
  EXPECT_EQ(built, 0);
  const ResponseSurface direct(surface().table(),
                               obtainSurface(parameters, brokenModel(), "broken tooth 40 ", cached())->deviations);
  EXPECT_EQ(direct.deviations().pitches.size(), 100u);  // half a turn
  ResponseSurface::Place here;
  ResponseSurface::Place there;
  for (double motor = -7.0; motor < 7.0; motor += 0.0137)
  {
    const double output = motor / 101.0 + 1.3e-3;
    ASSERT_TRUE(surfaces[1]->locate(motor, output, here) && direct.locate(motor, output, there));
    // Two rings, each solved to rounding at other angles.
    EXPECT_NEAR(surfaces[1]->response(here).output_torque, direct.response(there).output_torque, 2e-4);
    const double force = ResponseSurface::lobeForces(there)[0];
    EXPECT_NEAR(ResponseSurface::lobeForces(here)[0], force, 0.005 * force);
  }
}

/// Energy and torques are continuous where the tables of two pitches meet, whatever lines they have.
TEST(SurfaceDeviations, AreContinuousFromPitchToPitch)
{
  const std::optional<SurfaceTables> tables =
      obtainSurface(surfaceParameters(), brokenModel(), "broken tooth 40 ", cached());
  ASSERT_TRUE(tables);
  const ResponseSurface faulty(tables->table, tables->deviations);
  constexpr double BESIDE = 1e-12;  // rad
  const double pitch = TWO_PI / 200;
  for (int edge = -50; edge < 250; ++edge)
  {
    for (double v = -4e-3; v < 4e-3; v += 1.3e-4)
    {
      const double motor = edge * pitch;
      ResponseSurface::Place place;
      ASSERT_TRUE(faulty.locate(motor - BESIDE, v + motor / 101.0, place));
      const RingResponse before = faulty.response(place);
      ASSERT_TRUE(faulty.locate(motor + BESIDE, v + motor / 101.0, place));
      const RingResponse after = faulty.response(place);
      EXPECT_NEAR(before.energy, after.energy, 1e-9);
      EXPECT_NEAR(before.output_torque, after.output_torque, 1e-5);
      EXPECT_NEAR(before.wave_generator_torque, after.wave_generator_torque, 1e-6);
    }
  }
}

/// A place taken from a pitch with deviations to one without any has none.
TEST(SurfaceDeviations, AreNotKeptInAPlaceThatMovesOn)
{
  std::optional<SurfaceTables> tables = obtainSurface(surfaceParameters(), brokenModel(), "broken tooth 40 ", cached());
  ASSERT_TRUE(tables);
  for (std::size_t pitch = 1; pitch < tables->deviations.pitches.size(); pitch += 2)
  {
    tables->deviations.pitches[pitch] = {};
  }
  const ResponseSurface faulty(tables->table, tables->deviations);
  ResponseSurface::Place moving;
  for (int pitch = 0; pitch < 100; ++pitch)
  {
    const double motor = (pitch + 0.37) * TWO_PI / 200;
    ResponseSurface::Place fresh;
    ASSERT_TRUE(faulty.locate(motor, 2e-3 + motor / 101.0, moving));
    ASSERT_TRUE(faulty.locate(motor, 2e-3 + motor / 101.0, fresh));
    EXPECT_EQ(faulty.response(moving).energy, faulty.response(fresh).energy) << pitch;
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
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  Eigen::Array2d misses(0.0, 0.0);  // of output torque [N.m] and of a lobe's force [N], squares
  Eigen::Array2d sizes(0.0, 0.0);   // of the fault's effect on them
  for (int i = 0; i < 20000; ++i)
  {
    const double motor = 20.0 * (part(random) - 0.5);
    const double output = motor / 101.0 - 4e-3 * part(random);
    const auto at = [&](const ResponseSurface& which)
    {
      ResponseSurface::Place place;
      EXPECT_TRUE(which.locate(motor, output, place)) << motor;
      return Eigen::Array2d(which.response(place).output_torque, ResponseSurface::lobeForces(place)[0]);
    };
    misses += (at(one) - at(other)).square();
    sizes += (at(other) - at(surface())).square();
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
    FaultList faults;
    faults.set(parseFault(fault, parameters), 0);
    const JointModel model = JointFaults(parameters, faults).model();
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
      ResponseSurface::Place there;
      ResponseSurface::Place sound;
      ASSERT_TRUE(faulty.locate(motor, v + motor / 101.0, there) && surface().locate(motor, v + motor / 101.0, sound));
      effect += std::pow(deviation, 2);
      miss += std::pow(faulty.response(there).output_torque - surface().response(sound).output_torque - deviation, 2);
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
  const DeviationTable three = built(3);
  ASSERT_EQ(one.pitches.size(), 100U);
  ASSERT_EQ(three.pitches.size(), 100U);
  std::size_t nodes = 0;
  for (std::size_t i = 0; i < one.pitches.size(); ++i)
  {
    nodes += one.pitches[i].nodes.size();
    EXPECT_EQ(one.pitches[i].lines, three.pitches[i].lines);
    EXPECT_TRUE(one.pitches[i].nodes == three.pitches[i].nodes) << i;
  }
  EXPECT_GT(nodes, 0U);
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
  const DeviationTable one = built(shipped);
  const DeviationTable other = built(others);
  ASSERT_EQ(one.pitches.size(), 100U);
  ASSERT_EQ(other.pitches.size(), 100U);
  for (std::size_t i = 0; i < one.pitches.size(); ++i)
  {
    EXPECT_EQ(one.pitches[i].lines, other.pitches[i].lines);
    EXPECT_TRUE(one.pitches[i].nodes == other.pitches[i].nodes) << i;
  }
}

/// Where a tooth begins to touch no grid is fine enough: how often that is stands in the table, and is said.
TEST(SurfaceDeviations, TellHowOftenTheyMissTheirTolerance)
{
  const TemporaryFolder folder;
  std::string said;
  const SurfaceSource source{ folder.path().string(), {}, [&](const std::string& what) { said += what + '\n'; } };
  const std::optional<SurfaceTables> built =
      obtainSurface(surfaceParameters(), brokenModel(), "broken tooth 40 ", source);
  ASSERT_TRUE(built);
  const GridChecks& checks = built->deviations.checks;
  EXPECT_GT(checks.made, 1000);
  EXPECT_GT(checks.missed, 0);
  EXPECT_LT(checks.missed, 0.02 * checks.made);
  EXPECT_THAT(said, testing::HasSubstr("teeth that differ: " + std::to_string(checks.missed) + " of " +
                                       std::to_string(checks.made) + " checks between its nodes miss the tolerance"));
  EXPECT_LT(built->table.checks.worst, 5.0);
  EXPECT_THAT(said, testing::Not(testing::HasSubstr("response surface: ")));
}

TEST(SurfaceDeviations, ComeFromTheCacheAsTheyWereBuilt)
{
  const std::optional<SurfaceTables> built =
      obtainSurface(surfaceParameters(), brokenModel(), "broken tooth 40 ", cached());
  bool building = false;
  const std::optional<SurfaceTables> kept = obtainSurface(surfaceParameters(), brokenModel(), "broken tooth 40 ",
                                                          { cacheDirectory(), [&](double) { building = true; }, {} });
  ASSERT_TRUE(built && kept);
  EXPECT_FALSE(building);
  ASSERT_EQ(built->deviations.pitches.size(), kept->deviations.pitches.size());
  EXPECT_EQ(built->deviations.checks.missed, kept->deviations.checks.missed);
  EXPECT_EQ(built->table.teeth.checks.worst, kept->table.teeth.checks.worst);
  for (std::size_t i = 0; i < kept->deviations.pitches.size(); ++i)
  {
    EXPECT_EQ(built->deviations.pitches[i].lines, kept->deviations.pitches[i].lines);
    EXPECT_TRUE(built->deviations.pitches[i].nodes == kept->deviations.pitches[i].nodes);
  }
}

/// A ball that has dropped does in a gear with a broken tooth nearly what it does in one without.
TEST(SurfaceBalls, AddUpWithABrokenTooth)
{
  const Parameters parameters = surfaceParameters();
  FaultList tooth;
  tooth.set(parseFault(BROKEN_TOOTH, parameters), 0);
  FaultList both = tooth;
  both.set(parseFault("bearing_cage:1:3", parameters), 0);
  const SurfacePool::Surface with = surfaceWithFaults(parameters, both, cached());
  const SurfacePool::Surface without = surfaceWithFaults(parameters, tooth, cached());
  ASSERT_TRUE(with && without);
  EXPECT_FALSE(with->deviations().pitches.empty());
  SurfaceRing ring_without(parameters, JointFaults(parameters, tooth).model());
  SurfaceRing ring_with(parameters, JointFaults(parameters, both).model());
  std::mt19937 random(4);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (const double load : { -60.0, 60.0 })
  {
    ASSERT_TRUE(ring_without.insert() && ring_with.insert());
    double squares = 0.0;
    double miss_squares = 0.0;
    double motor = 0.0;
    for (int i = 0; i < 400; ++i)
    {
      motor += ring_with.pitch() * part(random);
      const double v = ring_with.twist(load) * (0.9 + 0.1 * part(random));
      ASSERT_TRUE(ring_without.moveTo(motor, v) && ring_with.moveTo(motor, v));
      ResponseSurface::Place place_with;
      ResponseSurface::Place place_without;
      ASSERT_TRUE(with->locate(motor, v + motor / 101.0, place_with));
      ASSERT_TRUE(without->locate(motor, v + motor / 101.0, place_without));
      const double effect =
          ring_without.measure()[SurfaceNode::ENERGY_BY_V] - ring_with.measure()[SurfaceNode::ENERGY_BY_V];
      const double tabled = with->response(place_with).output_torque - without->response(place_without).output_torque;
      squares += effect * effect;
      miss_squares += std::pow(tabled - effect, 2);
    }
    EXPECT_LT(std::sqrt(miss_squares / squares), 0.03) << load;
  }
}
}  // namespace
}  // namespace hjt
