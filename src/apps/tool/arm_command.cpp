// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "apps/common/motion_options.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/run_summary.hpp"
#include "recordings/arm_run.hpp"

namespace hjt
{
namespace
{
using PrintedArmRun = Printed<ArmRunOptions>;

int simulateArm(const PrintedArmRun& given)
{
  PrintedArmRun options = given;
  options.watch = consoleWatch();
  const ArmRun found = runArm(options);
  if (found.joints.empty())
  {
    std::cerr << "joint_twin: interrupted; " << options.out << " is not written\n";
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  Report report = reportOf(found);
  report.lines.insert(report.lines.begin(), { "output", "", options.out });
  printReport(options.json, report.lines, report.tables);
  warnOf(found.counters);
  warn(found.feedback_limited, "times a joint's controller was at its limit (limits: feedback of the arm's file)");
  warn(found.stop ? 1 : 0, "protective stop: the arm stands in its brakes from there on");
  const int written = reportWritten(options.out, options.json);
  return written == EXIT_DONE && found.stop ? EXIT_STOPPED : written;
}

void declare(Command& command, PrintedArmRun& options)
{
  command
      .add("motion", options.motion,
           "set points: timestamp, target_q_0 ... and, if there, target_qd_0 ..., target_qdd_0 ... of a controller's "
           "recording, or as `joint_twin checkup` writes them; or a program of moves")
      .required()
      .type("FILE.csv|FILE.yaml");
  command.add("--arm", options.arm, "name in config/arms, or a file").required().type("NAME|FILE.yaml");
  command.add("--identified", options.identified, "overlays of the joints, as `joint_twin identify --arm` writes them")
      .type("DIR")
      .existingDirectory();
  command
      .add("--out", options.out,
           "targets and actual angles, speeds, currents in a controller's columns, and the tool's position [m]; .bag: "
           "/joint_states as the arm's driver publishes it; .h5: as a run of `joint_twin sweep`")
      .required()
      .type("FILE.csv|FILE.bag|FILE.h5");
  command.add("--rate", options.rate, "of the rows [Hz]; default: that of the arm's states")
      .range(ROW_RATE.min, ROW_RATE.max);
  command.add("--fault", options.faults, "in a joint from its onset [s] on; may be given again")
      .type("JOINT:KIND:SEVERITY[:PLACE[:ONSET]]");
  addCommonOptions(command, options, options.json, options.force);
}

const Subcommand ARM{ Subject::JOINT, "arm", "run a whole arm in closed loop: its drives, links and controller",
                      declare, simulateArm };
}  // namespace
}  // namespace hjt
