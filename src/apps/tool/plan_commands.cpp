// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "apps/common/library_command.hpp"
#include "base/number_text.hpp"
#include "base/temporary_directory.hpp"
#include "base/whole_file.hpp"
#include "datasets/file_seal.hpp"
#include "datasets/plan.hpp"
#include "datasets/run_file.hpp"
#include "datasets/run_simulation.hpp"
#include "datasets/sweep.hpp"
#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "health/signature_file.hpp"
#include "output/output_file.hpp"
#include "output/process_end.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "params/field_table.hpp"
#include "recordings/signatures.hpp"
#include "surface/parallel_tasks.hpp"
#include "surface/surface_cache.hpp"

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
constexpr double SAMPLE = 1.0;  // longest computing time of a trial run [s]

/// Pool that makes no surface, but records which surfaces a twin requests.
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
    // The twin has no equilibrium, so the run of this twin will fail.
  }
  return asked->keys;
}

/// Counts the surfaces that runs need and the cache lacks. A surface counts once, for the first run that needs it.
class MissingSurfaces
{
public:
  explicit MissingSurfaces(std::string directory) : directory_(std::move(directory)) {}

  struct OfBlock
  {
    double count{};
    std::uint64_t first_run;     ///< first run with a missing surface; without one, the first run of the block
    std::size_t of_first_run{};  ///< number of missing surfaces of `first_run`
  };

  /// Counts the surfaces of a block. Checks runs for PATIENCE; the other runs are assumed to need as many per run.
  OfBlock of(const Plan& plan, const Plan::Block& block)
  {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::seconds PATIENCE{ 5 };
    const Clock::time_point begin = Clock::now();
    OfBlock missing{ 0.0, block.first };
    std::uint64_t looked = 0;
    for (; looked < block.size && Clock::now() - begin < PATIENCE; ++looked)
    {
      const std::uint64_t number = block.run(looked);
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
  std::set<std::uint64_t> drives_;  // hashes of the checked drives
  std::set<std::string> known_;
};

/// Text of a number with two significant digits, but at least with all digits before the decimal point.
std::string rounded(double number)
{
  constexpr double THREE_DIGITS = 99.5;
  return number < THREE_DIGITS ? roundedText(number, 2) : std::to_string(std::llround(number));
}

std::string shortTime(double seconds)
{
  constexpr double MINUTE = 60.0;
  constexpr double HOUR = 3600.0;
  constexpr double MANY = 100.0;  // a time of 100 units or more is printed in the next larger unit
  return seconds < MANY          ? rounded(seconds) + " s" :
         seconds < MANY * MINUTE ? rounded(seconds / MINUTE) + " min" :
                                   rounded(seconds / HOUR) + " h";
}

void printWarning(const std::string& text)
{
  std::cerr << "warning: " << text << '\n';
}

/// Prints number, expected time and size of the plan's runs, from a trial of one run for each class and duty cycle. The
/// trial builds response surfaces, which the source may store. @throws InputError, ParameterError if a run has no
/// equilibrium.
void printExpectation(const Plan& plan, unsigned jobs)
{
  SurfaceSource source = runSurfaces(plan, 1);
  source.progress = showProgress("building response surfaces");
  source.notice = [shown = std::set<std::string>()](const std::string& text) mutable
  {
    if (shown.insert(text).second)
    {
      printWarning(text);
    }
  };
  const SweepDirectory directory(plan, "");
  RunCourse course;
  RunSimulation simulation(plan, directory, source, course);
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
    // After the trial the surfaces of its run exist, unless the source stores none.
    const auto tried = static_cast<double>(needed.of_first_run);
    const double to_build = needed.count - (source.cache_directory.empty() ? 0.0 : tried);
    surfaces += to_build;
    surface_time += tried > 0.0 ? to_build * cost.surfaces / tried : 0.0;
    const auto runs = static_cast<double>(block.size);
    run_time += runs * (cost.ends + spec.duration / cost.real_time_factor);
    bytes += runs * dataSize(plan.recording(), spec);
    length += runs * spec.duration;
    std::cout << "runs " << block.first << " ... " << block.run(block.size - 1) << ": class " << spec.fault_class
              << ", duty " << spec.duty_name << ", " << rounded(cost.real_time_factor)
              << " times as fast as real time\n";
  }
  // All processors build one surface at a time. Each job simulates on one processor.
  const double together = std::min<double>(
      { static_cast<double>(jobs), static_cast<double>(processors()), static_cast<double>(plan.runs()) });
  std::vector<NamedValue> values{ { "runs", std::to_string(plan.runs()), "" } };
  if (plan.lives() != nullptr)
  {
    values.push_back({ "check-ups", std::to_string(plan.lives()->checkUps()), "" });
  }
  values.push_back({ "simulated time of all runs", shortTime(length), "" });
  values.push_back({ "response surfaces to build", std::to_string(std::llround(surfaces)), "" });
  values.push_back(
      { "expected time, " + std::to_string(jobs) + " jobs", shortTime(surface_time + run_time / together), "" });
  values.push_back({ "size of the numbers in all files", bytes > 0.0 ? rounded(bytes / 1e6) : "-", "MB" });
  printValues(values);
  std::cout << "The time is estimated from one run of each class and duty cycle, tried for at most " << SAMPLE
            << " s, and from the time that its first response surface takes.\n";
}

Watch sweepWatch()
{
  Watch watch = consoleWatch();
  watch.notice = printWarning;
  return watch;
}

struct SweepCommandOptions : Printed<SweepOptions>
{
  bool dry_run{};
  bool list{};
};

void printList(const Plan& plan, const SweepCommandOptions& options)
{
  const SweepDirectory directory(plan, options.out);
  std::cout << directory.indexHeader() << '\n';
  for (std::uint64_t run = options.shard; run < plan.runs(); run += options.shards)
  {
    OrderedJson record = directory.record(run);
    if (!record.is_object())
    {
      record = recordOf(checkedRun(plan, run), directory.runFileName(run));
      record["status"] = "pending";
      record[FILE_HASH] = nullptr;
    }
    std::cout << directory.indexRow(record) << '\n';
  }
}

void declare(OptionTable& table, SweepCommandOptions& options)
{
  addOptions(table, static_cast<SweepOptions&>(options));
  table.flag("--dry-run", options.dry_run, "check every run and print the expected time and size, without simulating");
  table.flag("--list", options.list, "print the index with every run of the plan, without simulating");
  table.flag("--json", options.json,
             "print as one JSON document on stdout how many runs were done, were already present, and failed");
}

void tellResult(const SweepCommandOptions& options, const SweepResult& result)
{
  if (options.json)
  {
    std::cout << documentOf(result).dump() << '\n';
  }
  else
  {
    std::cerr << "joint_twin: " << result.done << " runs done, " << result.present << " already present, "
              << result.failed << " failed, " << result.damaged << " damaged and repeated; index: " << result.index
              << "\n";
  }
  warn(result.rows_without_forces, WITHOUT_FORCES);
}

/// Runs `work` on the plan. With --list it only prints the index, with --dry-run only the expected time and size.
int workOff(const SweepCommandOptions& given, SweepResult (*work)(const SweepOptions&))
{
  if (given.list || given.dry_run)
  {
    const Plan plan(given.plan, given);
    if (work == sweepLives)
    {
      requireLives(plan, given.plan);
    }
    if (given.list)
    {
      printList(plan, given);
      return EXIT_DONE;
    }
    checkRuns(plan);
    printExpectation(plan, given.jobs);
    return EXIT_DONE;
  }
  SweepCommandOptions options = given;
  options.watch = sweepWatch();
  const SweepResult result = work(options);
  tellResult(options, result);
  if (interruptSignal() != 0)
  {
    std::cerr << "joint_twin: interrupted; the same command resumes the work\n";
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  return result.failed > 0 ? EXIT_FAILED : EXIT_DONE;
}

int runPlan(const SweepCommandOptions& options)
{
  return workOff(options, sweep);
}

int runLives(const SweepCommandOptions& options)
{
  return workOff(options, sweepLives);
}

const Subcommand SWEEP{ Subject::DATA_SET, "sweep", "simulate the runs of a plan, which form a labelled data set",
                        declare, runPlan };
const Subcommand LIVES{ Subject::DATA_SET, "lives",
                        "simulate lives of drives with check-ups at intervals of use: a run-to-failure data set",
                        declare, runLives };

struct SignaturesOptions : CommonOptions
{
  std::vector<std::string> plans;
  std::string out;
  std::string runs;
  std::string add;
  unsigned jobs{ SweepOptions().jobs };
};

/// Simulates the runs of all plans. Finished runs are kept. An interrupt ends the function early.
SweepResult workOff(const SignaturesOptions& options, const std::string& runs, const Watch& watch, SignatureRuns& found)
{
  SweepOptions sweeping;
  sweeping.jobs = options.jobs;
  sweeping.watch = watch;
  SweepResult sum;
  for (std::size_t i = 0; i < options.plans.size() && !watch.stopped(); ++i)
  {
    const Plan plan(options.plans[i], options);
    SweepDirectory directory(plan, runs + "/" + plan.name());
    directory.open();
    const SweepResult own = runSweep(plan, directory, sweeping);
    sum.done += own.done;
    sum.present += own.present;
    sum.failed += own.failed;
    if (!watch.stopped())
    {
      found.add(plan, directory);
    }
  }
  return sum;
}

int signatures(const SignaturesOptions& options)
{
  requireWritable(options.out, options.force);
  const std::optional<std::string> kept =
      options.add.empty() ? std::nullopt : std::make_optional(readFile(options.add));
  for (const std::string& path : options.plans)
  {
    checkSignaturePlan(Plan(path, options));
  }
  const TemporaryDirectory temporary;
  const Watch watch = sweepWatch();
  SignatureRuns found(printWarning);
  const SweepResult runs = workOff(options, options.runs.empty() ? temporary.path() : options.runs, watch, found);
  if (interruptSignal() != 0)
  {
    std::cerr << "joint_twin: interrupted"
              << (options.runs.empty() ? "; --runs would keep finished runs" : "; the same command resumes the work")
              << '\n';
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  const Parameters parameters = Plan(options.plans.front(), options).run(0).parameters;
  const std::string own = found.text(std::filesystem::path(options.out).stem().string(),
                                     *loadSignatures(parameters.indicators.signatures), parameters.life.rated_torque);
  writeTextFile(options.out, kept ? withRowsOf(*kept, options.add, own) : own);
  printReport(options.json, { { "output", "", options.out },
                              { "done", "runs done", runs.done },
                              { "present", "runs already present", runs.present },
                              { "failed", "runs that failed", runs.failed } });
  const int written = reportWritten(options.out, options.json);
  return runs.failed > 0 ? EXIT_FAILED : written;
}

void declare(OptionTable& table, SignaturesOptions& options)
{
  table
      .add("plans", options.plans,
           "plans as for `joint_twin sweep`, with format bag. The first class has no faults, each other class has one "
           "fault. Several motions or gears need a plan each (docs/own_gear.md)")
      .required()
      .type("PLAN.yaml");
  table.add("--out", options.out, "file for parameter indicators.signatures").required().type("FILE.yaml");
  table.add("--runs", options.runs, "directory where finished runs are kept; default: they are not kept").type("DIR");
  table.add("--add", options.add, "file of other signatures, which --out then contains too; default: none")
      .type("FILE.yaml");
  addJobsOption(table, options.jobs);
  addCommonOptions(table, options);
}

const Subcommand SIGNATURES{
  Subject::DATA_SET, "signatures",
  "changes of a gear's health indicators by each fault, from runs with and without the fault", declare, signatures
};
}  // namespace
}  // namespace hjt
