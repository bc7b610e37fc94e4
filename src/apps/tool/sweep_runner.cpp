// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tool/sweep_runner.hpp"

#include <iostream>
#include <memory>
#include <mutex>
#include <set>

#include "datasets/expectation.hpp"
#include "datasets/file_seal.hpp"
#include "datasets/run_file.hpp"
#include "datasets/sweep.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "output/run_summary.hpp"
#include "surface/surface_cache.hpp"

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
/// Surfaces of the user's cache, each once in memory; each remark about them once.
/// Those of drives with a wear of their own, which come but once, are not kept on the disk.
SurfaceSource sharedSurfaces(const Plan& plan, unsigned jobs)
{
  struct Remarks
  {
    std::mutex mutex;
    std::set<std::string> shown;
    Progress building{ "building response surfaces" };
  };
  const auto remarks = std::make_shared<Remarks>();
  const auto show = [remarks](double done)
  {
    const std::lock_guard<std::mutex> lock(remarks->mutex);
    remarks->building.update(done);
  };
  const auto tell = [remarks](const std::string& what)
  {
    const std::lock_guard<std::mutex> lock(remarks->mutex);
    if (remarks->shown.insert(what).second)
    {
      std::cerr << "warning: " << what << '\n';
    }
  };
  return { plan.lives() != nullptr ? "" : surfaceCacheDirectory(), show, tell,
           std::make_shared<SurfacePool>(jobs + 2) };
}

void printList(const Plan& plan, const SweepArguments& arguments)
{
  const SweepDirectory directory(plan, arguments.out);
  std::cout << directory.indexHeader() << '\n';
  for (std::uint64_t run = arguments.shard; run < plan.runs(); run += arguments.shards)
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
}  // namespace

void addSweepOptions(Command& command, SweepArguments& arguments)
{
  command.add("plan", arguments.plan, "what to run and record (docs/datasets.md)").required().type("PLAN.yaml");
  command.add("--out", arguments.out, "directory of runs and index; runs that stand there finished are kept")
      .required()
      .type("DIR");
  command.add("--jobs", arguments.jobs, "runs at the same time").range(1, 4096);
  command.flag("--dry-run", arguments.dry_run, "check every run, tell time and size to expect, run nothing");
  command.flag("--list", arguments.list, "print the index with every run of the plan, run nothing");
  command.flag("--json", arguments.json,
               "print the numbers of runs done, found and failed as one JSON document on stdout");
  addConfigurationOptions(command, arguments);
}

int sweep(const SweepArguments& arguments)
{
  SweepArguments with_overlays = arguments;
  for (const std::string& overlay : Plan::overlays(arguments.plan))
  {
    with_overlays.configs.push_back(overlay);
  }
  const Plan plan(arguments.plan, loadParameterMap(with_overlays));
  if (arguments.lives && plan.lives() == nullptr)
  {
    throw InputError(arguments.plan + " has no mapping 'lives'; joint_twin sweep works it off");
  }
  if (arguments.list)
  {
    printList(plan, arguments);
    return EXIT_DONE;
  }
  checkRuns(plan);
  if (arguments.dry_run)
  {
    printExpectation(plan, arguments.jobs, sharedSurfaces(plan, 1));
    return EXIT_DONE;
  }
  SweepDirectory directory(plan, arguments.out);
  directory.open();
  const InterruptScope interrupts;
  const SweepResult result =
      runSweep(plan, directory, { arguments.out, arguments.jobs, arguments.shard, arguments.shards, arguments.quiet },
               sharedSurfaces(plan, arguments.jobs));
  if (arguments.json && !arguments.quiet)
  {
    printReport(true, { { "index", "", arguments.out + "/index.csv" },
                        { "runs", "", plan.runs() },
                        { "done", "", result.done },
                        { "present", "", result.present },
                        { "failed", "", result.failed },
                        { "damaged", "", result.damaged },
                        { ROWS_WITHOUT_FORCES, "", result.rows_without_forces } });
  }
  else if (!arguments.quiet)
  {
    std::cerr << "joint_twin: " << result.done << " runs done, " << result.present << " were there, " << result.failed
              << " failed, " << result.damaged << " damaged ones done again; index: " << arguments.out
              << "/index.csv\n";
  }
  warn(arguments.quiet ? 0 : result.rows_without_forces,
       "rows without forces on the teeth (NaN): no equilibrium was found for them; index.csv says in which runs");
  if (interruptSignal() != 0)
  {
    std::cerr << "joint_twin: interrupted; the same command resumes\n";
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  return result.failed > 0 ? EXIT_FAILED : EXIT_DONE;
}
}  // namespace hjt
