// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/motion_options.hpp"
#include "datasets/check_up_file.hpp"
#include "output/run_summary.hpp"

namespace hjt
{
namespace
{
using PrintedCheckUp = Printed<CheckUpOptions>;

int checkup(const PrintedCheckUp& options)
{
  printReport(options.json, reportOf(writeCheckUp(options)).lines);
  return reportWritten(options.out, options.json);
}

void declare(Command& command, PrintedCheckUp& options)
{
  command.add("--arm", options.arm, "name in config/arms, or a file").required().type("NAME|FILE.yaml");
  command.add("--joint", options.joint, "that alone, as base or shoulder; default: all, one after the other")
      .type("NAME");
  command.add("--out", options.out, "the motion").required().type("FILE");
  command
      .add("--format", options.format,
           "csv: angles, rates and torques every 8 ms; urscript: a program; bag: trajectory_msgs/JointTrajectory on "
           "/joint_trajectory")
      .choice(CHECK_UP_FORMATS);
  addCommonOptions(command, options, options.json, options.force);
}

const Subcommand CHECKUP{ Subject::JOINT, "checkup",
                          "motion of an arm in which faults are seen best, within its limits of speed and torque",
                          declare, checkup };
}  // namespace
}  // namespace hjt
