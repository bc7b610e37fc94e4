// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <memory>

#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "surface/surface_cache.hpp"
#include "test/support/allocation_count.hpp"
#include "test_parameters.hpp"
#include "twin_runs.hpp"

namespace hjt
{
namespace
{
constexpr Stamp DURATION = 600 * MILLISECOND;
constexpr Stamp FAULT_STAMP = 300 * MILLISECOND;
constexpr Stamp LOOK_PERIOD = 10 * MILLISECOND;

/// One surface for all twins of this program, built once.
SurfaceSource surfaces()
{
  SurfaceSource source;
  static const auto POOL = std::make_shared<SurfacePool>(1);
  source.pool = POOL;
  return source;
}

class ObservedTwin : public testing::TestWithParam<const char*>
{
protected:
  static Twin makeTwin()
  {
    Twin twin(shippedParameters({ std::string("solver.scene=") + GetParam(), "input.command_timeout=10.0" }),
              surfaces());
    const Parameters& parameters = twin.parameters();
    give(twin, randomInputs(97, DURATION, 1.5, 60.0));
    twin.injectFault(FAULT_STAMP, parseFault("tooth_wear:0.5", parameters));
    return twin;
  }
};
INSTANTIATE_TEST_SUITE_P(Scenes, ObservedTwin, testing::Values("full_ring", "auto"),
                         [](const auto& scene) { return std::string(scene.param); });

/// Tooth forces, health and indicators are read every 10 ms from one of two twins; both stay the same in every bit.
TEST_P(ObservedTwin, RunsAsOneThatNobodyLooksAt)
{
  Twin alone = makeTwin();
  Twin observed = makeTwin();
  observed.watchSignals(true);
  ToothForces forces = observed.makeToothForces();
  ToothStress stress(observed.parameters().gear.teeth_flexspline);
  std::uint64_t on_surface = 0;
  while (alone.step(DURATION))
  {
    ASSERT_TRUE(observed.step(DURATION));
    ASSERT_EQ(numbers(observed.outputs()), numbers(alone.outputs())) << observed.stamp() << " ns";
    ASSERT_EQ(observed.onSurface(), alone.onSurface()) << observed.stamp() << " ns";
    on_surface += observed.onSurface() ? 1 : 0;
    if (observed.stamp() % LOOK_PERIOD == 0)
    {
      EXPECT_TRUE(observed.toothForces(forces));
      EXPECT_TRUE(observed.toothStress(stress));
      EXPECT_EQ(observed.health().solver_state, SolverState::OK);
      observed.signalIndicators();
    }
  }
  EXPECT_EQ(observed.counters().solver_failures, alone.counters().solver_failures);
  EXPECT_EQ(observed.counters().step_cuts, alone.counters().step_cuts);
  EXPECT_EQ(observed.counters().jumps, alone.counters().jumps);
  EXPECT_EQ(on_surface > 1000, std::string(GetParam()) == "auto") << on_surface;
}

/// Nor does a reset or a fault make the loop of an observed twin allocate.
TEST_P(ObservedTwin, AllocatesNothingInTheLoop)
{
  Twin twin = makeTwin();
  twin.watchSignals(true);
  ToothForces forces = twin.makeToothForces();
  ToothStress stress(twin.parameters().gear.teeth_flexspline);
  const std::size_t before = allocationCount();
  for (const Stamp duration : { DURATION, DURATION / 10 })
  {
    while (twin.step(duration))
    {
      if (twin.stamp() % LOOK_PERIOD == 0)
      {
        EXPECT_TRUE(twin.toothForces(forces));
        EXPECT_TRUE(twin.toothStress(stress));
        EXPECT_GE(twin.health().lobes.teeth_loaded, 0);
        twin.commandLoadTorque(twin.stamp(), 1e-3 * twin.encoders().output_angle);
      }
    }
    twin.reset(0);
  }
  EXPECT_EQ(allocationCount(), before);
}

/// A drive at 150 rad/s whose grease spoils: every step bears its share of the search for the cause.
TEST(ObservedAssessment, OfAWindowInAlarmComesWithinFiftyMilliseconds)
{
  Twin twin(
      shippedParameters({ "indicators.window_turns=4.0", "indicators.window_time=0.1", "indicators.baseline_windows=8",
                          "indicators.evidence_windows=1", "output.load_inertia=0.5" }));
  twin.watchSignals(true);
  const double allowed = 0.05 * twin.parameters().solver.rate;  // [steps]
  int late = 0;
  int latest = 0;
  while (twin.assessment().level == HealthLevel::OK && twin.stamp() < 8 * SECOND)
  {
    const Stamp next = nextInstant(twin);
    twin.commandMotorTorque(next, 0.14 + 0.05 * (150.0 - twin.outputs().motor_velocity));
    twin.step(next);
    if (twin.assessment().state == AssessmentState::ASSESSED && twin.activeFaults().empty())
    {
      twin.injectFault(next, parseFault("lubricant_degradation:1.0", twin.parameters()));
    }
    late = twin.assessment().windows < twin.signalIndicators().windows ? late + 1 : 0;
    latest = std::max(latest, late);
    ASSERT_LE(late, allowed);
  }
  EXPECT_GT(twin.assessment().level, HealthLevel::OK);
  EXPECT_GT(latest, 0.8 * allowed);
}

/// What one reader of the health learns of the solver, another learns as well.
TEST(ObservedHealth, HasAReportForEveryReader)
{
  // Steps are too long for the swing on a shaft that gives way, under a load that presses the bearing.
  Twin twin(goldenParameters({ "motor.presliding_angle=1.2e-3", "input.temperature=0.0" }));
  twin.commandLoadTorque(0, 150.0);
  advance(twin, 20 * MILLISECOND);
  for (int reader = 0; reader < 2; ++reader)
  {
    EXPECT_EQ(twin.health().solver_state, SolverState::DEGRADED);
    EXPECT_EQ(twin.health(19 * MILLISECOND).solver_state, SolverState::DEGRADED);
  }
  twin.reset(0);
  EXPECT_EQ(twin.health().solver_state, SolverState::OK);
  // A reader from before the reset.
  EXPECT_EQ(twin.health(20 * MILLISECOND).solver_state, SolverState::OK);
}
}  // namespace
}  // namespace hjt
