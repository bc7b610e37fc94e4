// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/motion_options.hpp"
#include "apps/tool/signal_options.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "recordings/indicators.hpp"

namespace hjt
{
namespace
{
using PrintedIndicators = Printed<IndicatorsOptions>;

int runIndicators(const PrintedIndicators& given)
{
  PrintedIndicators options = given;
  options.watch = consoleWatch();
  const AssessedWindows found = indicators(options);
  if (!found.windows.empty())
  {
    options.json ? printReport(true, reportOf(found).lines) : printSummary(found.windows);
  }
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  return found.unread.empty() && (options.baseline.empty() || found.is_judged) ? EXIT_DONE : EXIT_FAILED;
}

void declare(Command& command, PrintedIndicators& options)
{
  addSignalOptions(command, options);
  command
      .add("--model", options.models,
           "the twin's own recording of the same run, whose indicators are subtracted; once for each recording, in "
           "their order")
      .type("FILE.csv|FILE.bag|FILE.h5")
      .check(wrongSignalFile);
  command.flag("--windows", options.windows,
               "the recordings are bags with NAMESPACE/indicators: windows that were published, not signals");
  command.add("--baseline", options.baseline, "healthy reference; default: learned from the first windows")
      .type("FILE.yaml");
  command
      .flag("--carry", options.carry,
            "the reference is of another motion to and fro, best a check-up; the recordings of --model carry it to "
            "this one")
      .needs("--baseline")
      .needs("--model");
  command.add("--save-baseline", options.save_baseline, "writes the reference that was learned").type("FILE.yaml");
  command.add("--out", options.out, "CSV with a row per window").type("FILE.csv");
  addCommonOptions(command, options, options.json, options.force);
}

const Subcommand INDICATORS{
  Subject::RECORDING, "indicators",
  "health indicators and assessment of a recording, from encoders and torque or current alone", declare, runIndicators
};
}  // namespace
}  // namespace hjt
