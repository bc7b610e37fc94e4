// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <ostream>
#include <thread>

#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "surface/surface_cache.hpp"
#include "test_parameters.hpp"
#include "twin_runs.hpp"

namespace hjt
{
namespace
{
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
  static const auto POOL = std::make_shared<SurfacePool>(3);
  SurfaceSource source;
  source.pool = POOL;
  Twin twin(shippedParameters(assignments), source);
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
