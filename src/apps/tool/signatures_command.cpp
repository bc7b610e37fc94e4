// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "apps/tool/plan_options.hpp"
#include "base/temporary_directory.hpp"
#include "datasets/sweep.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "output/run_summary.hpp"
#include "recordings/signatures.hpp"

#include "base/whole_file.hpp"
#include "health/signature_file.hpp"

namespace hjt
{
namespace
{
struct SignaturesOptions : CommonOptions
{
  std::vector<std::string> plans;
  std::string out;
  std::string runs;
  std::string add;
  unsigned jobs{};
};

/// The runs of all plans; finished ones are kept. An interrupt ends it early.
SweepResult workOff(const SignaturesOptions& options, const std::string& runs, SignatureRuns& found)
{
  SweepResult sum;
  for (std::size_t i = 0; i < options.plans.size() && interruptSignal() == 0; ++i)
  {
    const Plan plan(options.plans[i], options);
    const std::string path = runs + "/" + plan.name();
    SweepDirectory directory(plan, path);
    directory.open();
    const SweepResult own = runSweep(plan, directory, { path, options.jobs, 0, 1 }, sharedSurfaces(plan, options.jobs));
    sum.done += own.done;
    sum.present += own.present;
    sum.failed += own.failed;
    if (interruptSignal() == 0)
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
  const InterruptScope interrupts;
  SignatureRuns found([](const std::string& what) { std::cerr << "warning: " << what << '\n'; });
  const SweepResult runs = workOff(options, options.runs.empty() ? temporary.path() : options.runs, found);
  if (interruptSignal() != 0)
  {
    std::cerr << "joint_twin: interrupted"
              << (options.runs.empty() ? "; with --runs finished runs are kept" : "; the same command resumes") << '\n';
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  const Parameters parameters = Plan(options.plans.front(), options).run(0).parameters;
  const std::string own = found.text(std::filesystem::path(options.out).stem().string(),
                                     *loadSignatures(parameters.indicators.signatures), parameters.life.rated_torque);
  writeTextFile(options.out, kept ? withRowsOf(*kept, options.add, own) : own);
  printReport(options.json, { { "output", "", options.out },
                              { "done", "runs done", runs.done },
                              { "present", "runs that were there", runs.present },
                              { "failed", "runs that failed", runs.failed } });
  const int written = reportWritten(options.out, options.json);
  return runs.failed > 0 ? EXIT_FAILED : written;
}

void declare(Command& command, SignaturesOptions& options)
{
  command
      .add("plans", options.plans,
           "as of sweep, in bags: a class without faults, then classes of one fault each; several for motions or gears "
           "of their own (docs/own_gear.md)")
      .required()
      .type("PLAN.yaml");
  command.add("--out", options.out, "for parameter indicators.signatures").required().type("FILE.yaml");
  command.add("--runs", options.runs, "directory of the runs; those that stand there finished are kept; default: none")
      .type("DIR");
  command.add("--add", options.add, "file of signatures that stay, those of the plans behind them; default: none")
      .type("FILE.yaml");
  addJobsOption(command, options.jobs);
  addCommonOptions(command, options);
}

const Subcommand SIGNATURES{
  Subject::DATA_SET, "signatures",
  "what each fault changes in the health indicators of a gear, from runs with and without it", declare, signatures
};
}  // namespace
}  // namespace hjt
