// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "apps/common/library_command.hpp"
#include "datasets/check_up_file.hpp"
#include "output/process_end.hpp"
#include "recordings/arm_run.hpp"

namespace hjt
{
namespace
{
using PrintedArmRun = Printed<ArmRunOptions>;

int printArmRun(const PrintedArmRun& options, const ArmRun& found)
{
  if (found.joints.empty())
  {
    std::cerr << "joint_twin: interrupted; " << options.out << " was not written\n";
    return EXIT_DONE;
  }
  Report report = reportOf(found);
  report.lines.insert(report.lines.begin(), { "output", "", options.out });
  printReport(options.json, report.lines, report.tables);
  warnOf(found.counters);
  warn(found.feedback_limited, "times the controller of a joint reached its limit (limits.feedback in the arm's file)");
  warn(found.stop ? 1 : 0, "protective stop; from then on the brakes hold the arm");
  const int written = reportWritten(options.out, options.json);
  return written == EXIT_DONE && found.stop ? EXIT_STOPPED : written;
}

void declare(OptionTable& table, PrintedArmRun& options)
{
  declarePrinted<ArmRunOptions>(table, options);
  table.find("--out")->required();
}

const Subcommand ARM{ Subject::JOINT, "arm",
                      "simulate a whole arm in closed loop with its drives, links and controller", declare,
                      runWatched<runArm, printArmRun, true, PrintedArmRun> };

int checkup(const Printed<CheckUpOptions>& options)
{
  printReport(options.json, reportOf(writeCheckUp(options)).lines);
  return reportWritten(options.out, options.json);
}

const Subcommand CHECKUP{ Subject::JOINT, "checkup",
                          "make the motion of an arm that shows faults best, within the limits of speed and torque",
                          declarePrinted<CheckUpOptions>, checkup };
}  // namespace
}  // namespace hjt
