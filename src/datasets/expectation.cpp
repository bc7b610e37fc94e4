// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/expectation.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "datasets/run_file.hpp"
#include "datasets/run_simulation.hpp"
#include "output/text_table.hpp"
#include "params/field_table.hpp"
#include "surface/parallel_tasks.hpp"
#include "surface/surface_cache.hpp"

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
constexpr double SAMPLE = 1.0;  // length of a trial run by the clock [s]

/// Notes which surfaces a twin asks for, and makes none.
class AskedSurfaces : public SurfacePool
{
public:
  AskedSurfaces() : SurfacePool(1) {}

  Surface obtain(const std::string& key, const std::function<Surface()>& /*make*/) override
  {
    keys.insert(key);
    return nullptr;
  }

  std::set<std::string> keys;
};

std::set<std::string> surfacesOf(const Parameters& parameters)
{
  const auto asked = std::make_shared<AskedSurfaces>();
  try
  {
    const Twin twin(parameters, { "", {}, {}, asked });
  }
  catch (const ParameterError&)
  {
    // No equilibrium: a run that fails.
  }
  return asked->keys;
}

/// Surfaces that runs need and that are neither kept nor of runs before.
class MissingSurfaces
{
public:
  explicit MissingSurfaces(std::string directory) : directory_(std::move(directory)) {}

  struct OfBlock
  {
    double count{};
    std::uint64_t first_run;     ///< the first that needs a surface; if none does, the block's first
    std::size_t of_first_run{};  ///< surfaces that this run needs
  };

  /// Every run is looked at for a few seconds; those after are like the ones before.
  OfBlock of(const Plan& plan, const Plan::Block& block)
  {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::seconds PATIENCE{ 5 };
    const Clock::time_point begin = Clock::now();
    OfBlock missing{ 0.0, block.first };
    std::uint64_t looked = 0;
    for (; looked < block.size && Clock::now() - begin < PATIENCE; ++looked)
    {
      const std::uint64_t number = block.first + looked * block.apart;
      const RunSpec spec = plan.run(number);
      std::size_t of_run = 0;
      for (const Parameters& parameters : spec.arm ? spec.arm->drives : std::vector{ spec.parameters })
      {
        if (parameters.solver.scene != SceneKind::AUTO || !drives_.insert(surfaceParametersHash(parameters)).second)
        {
          continue;
        }
        for (const std::string& key : surfacesOf(parameters))
        {
          of_run += known_.insert(key).second && !surfaceIsKept(key, directory_) ? 1 : 0;
        }
      }
      if (of_run > 0 && missing.of_first_run == 0)
      {
        missing.first_run = number;
        missing.of_first_run = of_run;
      }
      missing.count += static_cast<double>(of_run);
    }
    missing.count = std::round(missing.count * static_cast<double>(block.size) / static_cast<double>(looked));
    return missing;
  }

private:
  std::string directory_;
  std::set<std::uint64_t> drives_;  // looked at, by what shapes their surfaces
  std::set<std::string> known_;
};

/// Two digits, or the whole number.
std::string rounded(double number)
{
  constexpr double THREE_DIGITS = 99.5;
  return number < THREE_DIGITS ? roundedText(number, 2) : std::to_string(std::llround(number));
}

std::string shortTime(double seconds)
{
  constexpr double MINUTE = 60.0;
  constexpr double HOUR = 3600.0;
  constexpr double MANY = 100.0;  // larger values are shown in the next unit
  return seconds < MANY          ? rounded(seconds) + " s" :
         seconds < MANY * MINUTE ? rounded(seconds / MINUTE) + " min" :
                                   rounded(seconds / HOUR) + " h";
}
}  // namespace

void printExpectation(const Plan& plan, unsigned jobs, const SurfaceSource& source)
{
  const SweepDirectory directory(plan, "");
  std::atomic<std::uint64_t> simulated{};
  RunSimulation simulation(plan, directory, source, simulated);
  MissingSurfaces missing(source.cache_directory);
  double run_time = 0.0;
  double surface_time = 0.0;
  double surfaces = 0.0;
  double bytes = 0.0;
  double length = 0.0;
  for (const Plan::Block& block : plan.blocks())
  {
    const RunSpec spec = plan.run(block.first);
    const MissingSurfaces::OfBlock needed = missing.of(plan, block);
    const RunCost cost = simulation.sample(needed.first_run, SAMPLE);
    // Those of the tried run are there from now on, unless none are kept.
    const auto tried = static_cast<double>(needed.of_first_run);
    const double to_build = needed.count - (source.cache_directory.empty() ? 0.0 : tried);
    surfaces += to_build;
    surface_time += tried > 0.0 ? to_build * cost.surfaces / tried : 0.0;
    const auto runs = static_cast<double>(block.size);
    run_time += runs * (cost.ends + spec.duration / cost.real_time_factor);
    bytes += runs * dataSize(plan.recording(), spec);
    length += runs * spec.duration;
    std::cout << "runs " << block.first << " ... " << block.last() << ": class " << spec.fault_class << ", duty "
              << spec.duty_name << ", " << rounded(cost.real_time_factor) << " times real time\n";
  }
  // A surface is built on all processors.
  const double together = std::min<double>(
      { static_cast<double>(jobs), static_cast<double>(processors()), static_cast<double>(plan.runs()) });
  std::vector<NamedValue> values{ { "runs", std::to_string(plan.runs()), "" } };
  if (plan.lives() != nullptr)
  {
    values.push_back({ "check-ups", std::to_string(plan.lives()->checkUps()), "" });
  }
  values.push_back({ "simulated, together", shortTime(length), "" });
  values.push_back({ "response surfaces to build", std::to_string(std::llround(surfaces)), "" });
  values.push_back(
      { "expected time, " + std::to_string(jobs) + " jobs", shortTime(surface_time + run_time / together), "" });
  values.push_back({ "numbers of all files", bytes > 0.0 ? rounded(bytes / 1e6) : "-", "MB" });
  printValues(values);
  std::cout << "The time is estimated from one run of each class and duty cycle, tried for at most " << SAMPLE
            << " s, and from building its first response surface.\n";
}
}  // namespace hjt
