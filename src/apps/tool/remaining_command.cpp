// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/motion_options.hpp"
#include "apps/tool/signal_options.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "recordings/remaining.hpp"

namespace hjt
{
namespace
{
using PrintedRemaining = Printed<RemainingOptions>;

int runRemaining(const PrintedRemaining& given)
{
  PrintedRemaining options = given;
  options.watch = consoleWatch();
  const Report report = reportOf(remaining(options));
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  printReport(options.json, report.lines, report.tables);
  return EXIT_DONE;
}

void declare(Command& command, PrintedRemaining& options)
{
  addSignalOptions(command, options);
  command.add("--hours", options.hours,
              "hours of use behind the drive, all as in the recordings [h]; default: those of the recordings. A list, "
              "ascending: "
              "the hours at which each recording was made");
  command
      .add("--baseline", options.baseline,
           "reference of the new drive, from `indicators`: verdicts and readings by it tell of wear")
      .type("FILE.yaml");
  command
      .add("--duty", options.duty,
           "use so far, as a duty cycle that `life age` reads; the recordings are then assessed only")
      .type("FILE.csv")
      .existingFile()
      .needs("--baseline");
  command
      .add("--lost-motion-limit", options.lost_motion_limit,
           "lost motion at which the drive is at its end, beside the limits of wear [rad]; 1e-6 ... 0.1")
      .needs("--baseline");
  command.add("--use-record", options.use_record, "writes the use as a duty cycle, for `life` and life.use_record")
      .type("FILE.csv");
  addCommonOptions(command, options, options.json, options.force);
}

const Subcommand REMAINING{ Subject::RECORDING, "remaining",
                            "use of a recorded joint, and how long a drive lasts that is used so", declare,
                            runRemaining };
}  // namespace
}  // namespace hjt
