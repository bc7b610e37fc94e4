// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

#include "apps/common/configuration.hpp"
#include "apps/tool/plan_options.hpp"
#include "datasets/expectation.hpp"
#include "datasets/file_seal.hpp"
#include "datasets/run_file.hpp"
#include "datasets/sweep.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/report.hpp"
#include "output/run_summary.hpp"

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
struct SweepCommandOptions : CommonOptions
{
  std::string plan;
  std::string out;
  unsigned jobs{};
  std::string part;
  std::uint64_t shard{};
  std::uint64_t shards{ 1 };
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

void declare(Command& command, SweepCommandOptions& options)
{
  command.add("plan", options.plan, "what to run and record (docs/datasets.md)").required().type("PLAN.yaml");
  command.add("--out", options.out, "directory of runs and index; runs that stand there finished are kept")
      .required()
      .type("DIR");
  addJobsOption(command, options.jobs);
  command.flag("--dry-run", options.dry_run, "check every run, tell time and size to expect, run nothing");
  command.flag("--list", options.list, "print the index with every run of the plan, run nothing");
  command.flag("--json", options.json,
               "print the numbers of runs done, found and failed as one JSON document on stdout");
  addConfigurationOptions(command, options);
  command.add("--shard", options.part, "only every N-th run, from run I on: one of N processes, anywhere")
      .type("I/N")
      .check(
          [&options](const std::string& text)
          {
            char slash = 0;
            std::istringstream stream(text);
            const bool read = static_cast<bool>(stream >> options.shard >> slash >> options.shards);
            return read && stream.peek() == EOF && slash == '/' && options.shard < options.shards ?
                       std::string() :
                       "'" + text + "' must be I/N with 0 <= I < N";
          });
}

void tellResult(const SweepCommandOptions& options, const Plan& plan, const SweepResult& result)
{
  const std::string index = options.out + "/index.csv";
  if (options.json)
  {
    printReport(true, { { "index", "", index },
                        { "runs", "", plan.runs() },
                        { "done", "", result.done },
                        { "present", "", result.present },
                        { "failed", "", result.failed },
                        { "damaged", "", result.damaged },
                        { ROWS_WITHOUT_FORCES, "", result.rows_without_forces } });
  }
  else
  {
    std::cerr << "joint_twin: " << result.done << " runs done, " << result.present << " were there, " << result.failed
              << " failed, " << result.damaged << " damaged ones done again; index: " << index << "\n";
  }
  warn(result.rows_without_forces,
       "rows without forces on the teeth (NaN): no equilibrium was found for them; index.csv says in which runs");
}

int workOff(const SweepCommandOptions& options, const Plan& plan)
{
  if (options.list)
  {
    printList(plan, options);
    return EXIT_DONE;
  }
  checkRuns(plan);
  if (options.dry_run)
  {
    printExpectation(plan, options.jobs, sharedSurfaces(plan, 1));
    return EXIT_DONE;
  }
  SweepDirectory directory(plan, options.out);
  directory.open();
  const InterruptScope interrupts;
  const SweepResult result = runSweep(plan, directory, { options.out, options.jobs, options.shard, options.shards },
                                      sharedSurfaces(plan, options.jobs));
  tellResult(options, plan, result);
  if (interruptSignal() != 0)
  {
    std::cerr << "joint_twin: interrupted; the same command resumes\n";
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  return result.failed > 0 ? EXIT_FAILED : EXIT_DONE;
}

int sweep(const SweepCommandOptions& options)
{
  return workOff(options, Plan(options.plan, options));
}

int sweepLives(const SweepCommandOptions& options)
{
  const Plan plan(options.plan, options);
  if (plan.lives() == nullptr)
  {
    throw InputError(options.plan + " has no mapping 'lives'; run it with joint_twin sweep");
  }
  return workOff(options, plan);
}

const Subcommand SWEEP{ Subject::DATA_SET, "sweep", "run a plan of many runs: a labelled data set", declare, sweep };
const Subcommand LIVES{ Subject::DATA_SET, "lives",
                        "drives from new to their end, with a check-up every so often: a data set of run to failure",
                        declare, sweepLives };
}  // namespace
}  // namespace hjt
