// SPDX-License-Identifier: BSD-3-Clause

#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <ostream>
#include <thread>

#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "surface/surface_cache.hpp"
#include "test/core/test_parameters.hpp"
#include "test/core/twin_runs.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
constexpr Stamp DURATION = 600 * MILLISECOND;
constexpr Stamp FAULT_STAMP = 300 * MILLISECOND;
constexpr Stamp LOOK_PERIOD = 10 * MILLISECOND;

/// Surfaces for all twins of this program, each built once.
SurfaceSource surfaces()
{
  SurfaceSource source;
  static const auto POOL = std::make_shared<SurfacePool>(3);
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

constexpr Stamp COPIED = 150 * MILLISECOND;
constexpr Stamp END = 400 * MILLISECOND;

struct Kind
{
  const char* name;
  std::vector<std::string> assignments;
  std::string fault{};  // injected at the start
};

std::ostream& operator<<(std::ostream& stream, const Kind& kind)
{
  return stream << kind.name;
}

/// With all that a twin has of errors of its sensors, heat and indicators.
const std::vector<std::string> ALL{ "input.command_timeout=10.0",    "thermal.model=two_nodes",
                                    "sensors.motor_noise=1.0e-4",    "sensors.output_noise=1.0e-5",
                                    "sensors.torque_noise=0.01",     "sensors.delay=0.002",
                                    "indicators.window_turns=2.0",   "indicators.window_time=0.1",
                                    "indicators.baseline_windows=8", "indicators.evidence_windows=1" };

Twin makeTwin(const Kind& kind)
{
  std::vector<std::string> assignments = ALL;
  assignments.insert(assignments.end(), kind.assignments.begin(), kind.assignments.end());
  Twin twin(shippedParameters(assignments), surfaces());
  twin.watchSignals(true);
  give(twin, randomInputs(29, END, 1.5, 60.0));
  if (!kind.fault.empty())
  {
    twin.injectFault(0, parseFault(kind.fault, twin.parameters()));
  }
  return twin;
}

/// All that a twin tells at one instant.
std::vector<double> everything(const Twin& twin)
{
  std::vector<double> all = numbers(twin.outputs());
  const auto add = [&](std::initializer_list<double> more) { all.insert(all.end(), more); };
  const EncoderReadings readings = twin.encoders();
  add({ readings.motor_angle, readings.output_angle, readings.motor_velocity, readings.output_velocity,
        twin.motorTorqueReading() });
  const JointOutputs outputs = twin.outputs();
  add({ outputs.temperature, outputs.housing_temperature, outputs.dissipated_energy, outputs.released_energy });
  const HealthReport health = twin.health();
  add({ health.motion.transmission_ratio.value, health.motion.torsion, health.motion.torsional_stiffness.value,
        health.motion.efficiency.value, health.motion.kinematic_error.value, health.lobes.mesh_force[0],
        health.lobes.mesh_force[1] });
  const SignalIndicators& signals = twin.signalIndicators();
  add({ static_cast<double>(signals.windows), static_cast<double>(signals.stamp) });
  for (const double value : signals.values)
  {
    all.push_back(std::isnan(value) ? -1.0 : value);
  }
  const Assessment& assessment = twin.assessment();
  add({ static_cast<double>(assessment.state), assessment.confidence, assessment.largest_score });
  const TwinCounters& counters = twin.counters();
  for (const std::uint64_t count : { counters.steps, counters.step_cuts, counters.jumps, counters.coarse_steps,
                                     counters.input.accepted, counters.faults.accepted, counters.torque_clamped })
  {
    all.push_back(static_cast<double>(count));
  }
  all.push_back(twin.onSurface() ? 1.0 : 0.0);
  return all;
}

std::vector<std::vector<double>> runToEnd(Twin& twin)
{
  ToothForces forces = twin.makeToothForces();
  std::vector<std::vector<double>> rows;
  while (twin.step(END))
  {
    if (twin.stamp() % (5 * MILLISECOND) == 0)
    {
      rows.push_back(everything(twin));
      EXPECT_TRUE(twin.toothForces(forces));
      rows.push_back(forces.mesh_force);
    }
  }
  return rows;
}

using TwinCopy = testing::TestWithParam<Kind>;
INSTANTIATE_TEST_SUITE_P(
    Kinds, TwinCopy,
    testing::Values(Kind{ "ring", { "solver.scene=full_ring" } }, Kind{ "surface", { "solver.scene=auto" } },
                    // Set in before the copy and after it; the second waits in the copy.
                    Kind{ "fault", { "solver.scene=auto" }, "tooth_wear:0.5:-1:0.1" },
                    Kind{ "fault_to_come", { "solver.scene=auto" }, "tooth_wear:0.5:-1:0.2" },
                    Kind{ "friction_that_remembers",
                          { "solver.scene=full_ring", "motor.presliding_angle=0.01", "brake.play=0.01" } }),
    [](const auto& kind) { return std::string(kind.param.name); });

/// From the instant of the copy on both give the same bits, one after the other, the first gone before the second runs.
TEST_P(TwinCopy, GoesOnWithTheSameBits)
{
  auto original = std::make_unique<Twin>(makeTwin(GetParam()));
  advance(*original, COPIED);
  Twin copy = *original;
  EXPECT_EQ(everything(copy), everything(*original));
  const std::vector<std::vector<double>> rows = runToEnd(*original);
  ASSERT_GT(original->signalIndicators().windows, copy.signalIndicators().windows);
  original.reset();
  ASSERT_EQ(copy.stamp(), COPIED);
  EXPECT_TRUE(runToEnd(copy) == rows);
}

/// A state that was kept is taken up as often as one likes.
TEST_P(TwinCopy, IsAStateToComeBackTo)
{
  Twin twin = makeTwin(GetParam());
  advance(twin, COPIED);
  const Twin kept = twin;
  const std::vector<std::vector<double>> rows = runToEnd(twin);
  twin.reset(0);
  twin = kept;
  EXPECT_TRUE(runToEnd(twin) == rows);
}

/// A copy made while the table is being built gets it by itself; one made later has it.
TEST(TwinCopyInTheBackground, HasASurfaceToo)
{
  SurfaceSource source;
  source.pool = std::make_shared<SurfacePool>(1);
  source.background = true;
  Twin original(shippedParameters({ "solver.scene=auto" }), source);
  Twin early = original;
  for (Twin* twin : { &early, &original })
  {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (!twin->onSurface())
    {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline);
      twin->step(twin->stamp() + twin->stepLength());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  Twin late = original;
  EXPECT_TRUE(late.onSurface());
  for (Twin* twin : { &original, &late })
  {
    twin->commandLoadTorque(twin->stamp(), 10.0);
    advance(*twin, twin->stamp() + 10 * MILLISECOND);
  }
  EXPECT_EQ(everything(late), everything(original));
}
}  // namespace
}  // namespace hjt
