// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>

#include "ring_fixture.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
/// A gear and a load that it carries.
struct LoadedGear
{
  const char* name;
  std::vector<std::string> assignments;
  std::vector<std::string> overlays;
  double torque;  // [N.m]
};

const std::vector<LoadedGear> GEARS{
  { "size 25", {}, {}, 200.0 },
  { "size 14", {}, { "size_14" }, 100.0 },
  { "soft cup", { "cup.torsion_stiffness=[8.0e+3, 8.0e+3, 8.0e+3]" }, {}, 150.0 },
  { "very soft cup", { "cup.torsion_stiffness=[500.0, 500.0, 500.0]" }, {}, 150.0 },
  { "backlash", { "mesh.flank_clearance=20.0e-6" }, {}, 5.0 },
  { "much backlash", { "mesh.flank_clearance=150.0e-6" }, {}, 20.0 },
  { "stiff rim", { "ring.tension_stiffness=5.0e+11" }, {}, 100.0 },
};

/// The ring without load, solved as statics are.
struct UnloadedRing : InsertedRing
{
  explicit UnloadedRing(const LoadedGear& gear) : InsertedRing(solvedTightly(gear))
  {
    EXPECT_TRUE(balanceOutput(ring, 0.0, 0.0).ok()) << gear.name;
  }

  static Parameters solvedTightly(const LoadedGear& gear)
  {
    Parameters parameters = goldenParameters(gear.assignments, gear.overlays);
    parameters.solver.force_tolerance = 5e-7;
    return parameters;
  }
};

TEST(OutputBalance, FindsOneTorqueHoweverFarItTurnsTheOutput)
{
  for (const LoadedGear& gear : GEARS)
  {
    for (const double torque : { gear.torque, -gear.torque })
    {
      UnloadedRing unloaded(gear);
      ASSERT_TRUE(balanceOutput(unloaded.ring, 0.0, torque).ok()) << gear.name << ", " << torque << " N.m";
      EXPECT_NEAR(unloaded.ring.forces().output_torque, torque, 1e-8 * gear.torque) << gear.name;
    }
  }
}

TEST(OutputBalance, DoesNotDependOnTheTorquesBefore)
{
  constexpr double SAME = 1e-10;  // rad
  for (const LoadedGear& gear : GEARS)
  {
    UnloadedRing at_once(gear);
    ASSERT_TRUE(balanceOutput(at_once.ring, 0.0, gear.torque).ok()) << gear.name;
    UnloadedRing by_parts(gear);
    for (const double part : { 0.1, 0.2, 0.5, 1.1, -0.4, 0.7, 1.0 })
    {
      ASSERT_TRUE(balanceOutput(by_parts.ring, 0.0, part * gear.torque).ok()) << gear.name << ", " << part;
    }
    EXPECT_NEAR(at_once.ring.position().output_angle, by_parts.ring.position().output_angle, SAME) << gear.name;
  }
}

TEST(OutputBalance, OfALoadBeyondTheTeethSaysWhatTheyDoNotCarry)
{
  UnloadedRing unloaded({ "soft wave generator",
                          { "contact.stiffness=1.0e+6", "ring.tension_stiffness=5.0e+7", "mesh.flank_angle=1.0",
                            "mesh.engagement_depth=200.0e-6" },
                          {},
                          2000.0 });
  const SolveStatus status = balanceOutput(unloaded.ring, 0.0, 2000.0);
  EXPECT_EQ(status.code, SolveCode::UNBALANCED);
  EXPECT_EQ(status.stage, SolveStage::BALANCE);
  EXPECT_NEAR(status.unbalanced_torque, 2000.0 - unloaded.ring.forces().output_torque, 1e-9);
  EXPECT_GT(status.unbalanced_torque, 1000.0);
  EXPECT_TRUE(unloaded.ring.shape().points.allFinite());
  EXPECT_NE(explanationOf(status).find("no output angle balances the load (UNBALANCED, "), std::string::npos);
}

TEST(OutputBalance, OfTeethThatDoNotReachEachOtherSaysSo)
{
  UnloadedRing unloaded({ "thin rim", { "gear.rim_thickness=0.4e-3" }, {}, 5.0 });
  const SolveStatus status = balanceOutput(unloaded.ring, 0.0, 5.0);
  EXPECT_EQ(status.code, SolveCode::DISENGAGED);
  EXPECT_NE(explanationOf(status).find("no tooth touches"), std::string::npos);
  EXPECT_NE(explanationOf(status).find("gear.rim_thickness"), std::string::npos);
  EXPECT_EQ(explanationOf(status).find("solver.max_iterations"), std::string::npos);
}

TEST(SolveStatus, NamesTheIterationsOnlyWhereTheShippedLimitIsHigher)
{
  const std::string shipped = std::to_string(shippedParameters().solver.max_iterations);
  const Parameters parameters =
      goldenParameters({ "contact.stiffness=1.0e+12", "solver.max_iterations=1", "solver.max_step_cuts=0" });
  const RingModel model(parameters);
  SolveStatus status = RingEquilibrium(model, parameters.solver).insert({ 0.0, 0.0, parameters.gear.wave_amplitude });
  EXPECT_EQ(status.code, SolveCode::ITERATION_LIMIT);
  EXPECT_EQ(status.stage, SolveStage::INSERTION);
  const std::string lowered = explanationOf(status);
  EXPECT_THAT(lowered, testing::HasSubstr("raise solver.max_iterations from 1 to the shipped " + shipped));
  EXPECT_THAT(lowered, testing::Not(testing::HasSubstr("gear.wave_amplitude")));
  status = {};
  status.code = SolveCode::ITERATION_LIMIT;
  for (const SolveStage stage : { SolveStage::INSERTION, SolveStage::MOTION, SolveStage::BALANCE })
  {
    status.stage = stage;
    status.max_iterations = shippedParameters().solver.max_iterations;
    EXPECT_THAT(explanationOf(status), testing::Not(testing::HasSubstr("max_iterations")));
    EXPECT_EQ(explanationOf(status).find("gear.wave_amplitude") != std::string::npos, stage == SolveStage::INSERTION);
    status.max_iterations -= 1;
    EXPECT_THAT(explanationOf(status), testing::HasSubstr("raise solver.max_iterations"));
  }
}

TEST(OutputBalance, OfNoNumberIsRefused)
{
  UnloadedRing unloaded(GEARS[0]);
  EXPECT_EQ(balanceOutput(unloaded.ring, 0.0, std::nan("")).code, SolveCode::NOT_FINITE);
  EXPECT_FALSE(balanceOutput(unloaded.ring, std::nan(""), 10.0).ok());
  EXPECT_TRUE(balanceOutput(unloaded.ring, 0.0, 10.0).ok());
}
}  // namespace
}  // namespace hjt
