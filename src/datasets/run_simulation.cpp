// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/run_simulation.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "output/interrupt.hpp"
#include "output/run_summary.hpp"

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
using Json = OrderedJson;

/// At the start of a run.
void start(Twin& twin, const Recording& recording)
{
  twin.watchSignals(recording.format == RunFormat::BAG);  // a bag holds the indicators, from the start on
  twin.reset(SIMULATION_EPOCH);
}
}  // namespace

bool RunSimulation::simulate(std::uint64_t number)
{
  const RunSpec spec = plan_.run(number);
  Json record = recordOf(spec, directory_.runFileName(number));
  const std::string path = directory_.runFile(number);
  std::optional<Twin> twin;
  try
  {
    twin.emplace(spec.parameters, surface_source_);
  }
  catch (const ParameterError& error)
  {
    record["status"] = "failed";
    record["error"] = error.what();
    makeRunFile(plan_.recording(), spec, nullptr, path)->finish(record);
    return true;
  }
  start(*twin, plan_.recording());
  const auto file = makeRunFile(plan_.recording(), spec, &*twin, path);
  if (!march(*twin, spec, *file, Clock::time_point::max()))
  {
    return false;
  }
  const TwinCounters& counters = twin->counters();
  if (counters.solver_failures > 0)
  {
    record["status"] = "failed";
    record["error"] = "the solver found no equilibrium at " + numberText(toSeconds(twin->stamp() - SIMULATION_EPOCH)) +
                      " s; the record ends there";
  }
  record["steps"] = counters.steps;
  record["steps_on_surface"] = on_surface_;
  record["coarse_steps"] = counters.coarse_steps;
  record["torque_clamped"] = counters.torque_clamped;
  record["jumps"] = counters.jumps;
  file->finish(record);
  return true;
}

RunCost RunSimulation::sample(std::uint64_t number, double seconds)
{
  const auto since = [](Clock::time_point begin)
  { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const RunSpec spec = plan_.run(number);
  const std::string path = (std::filesystem::temp_directory_path() /
                            ("joint_twin_" + std::to_string(getpid()) + runFileExtension(plan_.recording().format)))
                               .string();
  RunCost cost;
  const Clock::time_point first_begin = Clock::now();
  const Twin first(spec.parameters, surface_source_);  // has to build its surfaces, once for all runs
  cost.surfaces = since(first_begin);
  const Clock::time_point begin = Clock::now();
  Twin twin(spec.parameters, surface_source_);
  start(twin, plan_.recording());
  const auto file = makeRunFile(plan_.recording(), spec, &twin, path);
  cost.ends = since(begin);
  const Clock::time_point marched = Clock::now();
  const auto budget = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  march(twin, spec, *file, marched + budget);
  cost.real_time_factor = toSeconds(twin.stamp() - SIMULATION_EPOCH) / since(marched);
  const Clock::time_point marched_to = Clock::now();
  file->finish(recordOf(spec, path));
  std::filesystem::remove(path);
  cost.ends += since(marched_to);
  return cost;
}

/// False: interrupted.
bool RunSimulation::march(Twin& twin, const RunSpec& spec, RunFile& file, Clock::time_point until)
{
  constexpr std::uint64_t STEPS_PER_LOOK = 1024;
  const Recording& recording = plan_.recording();
  const Stamp end = SIMULATION_EPOCH + toStampLength(spec.duration);
  const double step = toSeconds(twin.stepLength());
  const auto look = static_cast<std::uint64_t>(
      std::llround(std::min(1.0, STEPS_PER_LOOK * step / spec.duration) * static_cast<double>(WHOLE)));
  DutyFeeder feeder(spec.duty, twin);
  on_surface_ = 0;
  for (std::uint64_t steps = 1;; ++steps)
  {
    const double time = static_cast<double>(steps) * step;
    feeder.feed(twin, time);
    if (recording.indicators && time > recording.start)
    {
      twin.watchSignals(true);  // a window that held the start would stand apart from all others
    }
    if (!twin.step(end))
    {
      return true;
    }
    on_surface_ += twin.onSurface() ? 1 : 0;
    if (twin.counters().solver_failures > 0)
    {
      return true;
    }
    file.record(twin, feeder);
    if (steps % STEPS_PER_LOOK == 0)
    {
      simulated_ += look;
      if (interruptSignal() != 0)
      {
        return false;
      }
      if (Clock::now() > until)
      {
        return true;
      }
    }
  }
}
}  // namespace hjt
