// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/library_command.hpp"
#include "recordings/indicators.hpp"
#include "recordings/remaining.hpp"

namespace hjt
{
namespace
{
using PrintedIndicators = Printed<IndicatorsOptions>;

int printIndicators(const PrintedIndicators& options, const AssessedWindows& found)
{
  if (!found.windows.empty())
  {
    options.json ? printReport(true, reportOf(found).lines) : printSummary(found.windows);
  }
  return found.unread.empty() && (options.baseline.empty() || found.is_judged) ? EXIT_DONE : EXIT_FAILED;
}

const Subcommand INDICATORS{ Subject::RECORDING, "indicators",
                             "health indicators and assessment of a recording, from encoders and torque or current "
                             "alone",
                             declarePrinted<IndicatorsOptions>,
                             runWatched<indicators, printIndicators, true, PrintedIndicators> };

using PrintedRemaining = Printed<RemainingOptions>;

int printRemaining(const PrintedRemaining& options, const Remaining& found)
{
  const Report report = reportOf(found);
  printReport(options.json, report.lines, report.tables);
  return EXIT_DONE;
}

const Subcommand REMAINING{ Subject::RECORDING, "remaining",
                            "use of a recorded joint, and how long a drive lasts that is used so",
                            declarePrinted<RemainingOptions>,
                            runWatched<remaining, printRemaining, false, PrintedRemaining> };
}  // namespace
}  // namespace hjt
