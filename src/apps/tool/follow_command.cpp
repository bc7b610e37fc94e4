// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <string>

#include "apps/common/motion_options.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "recordings/follow.hpp"

namespace hjt
{
namespace
{
struct PrintedFollow : Printed<FollowOptions>
{
  std::string mode_name{ "motion" };
};

const std::map<std::string, InputMode> MODES{ { "torque", InputMode::TORQUE },
                                              { "motion", InputMode::MOTION },
                                              { "observer", InputMode::OBSERVER } };

int runFollow(const PrintedFollow& given)
{
  PrintedFollow options = given;
  options.mode = MODES.at(options.mode_name);
  options.watch = consoleWatch();
  const Followed followed = follow(options);
  if (!followed.joints.empty())
  {
    const Report report = reportOf(followed);
    printReport(options.json, report.lines, report.tables);
  }
  return interruptSignal() == 0 ? EXIT_DONE : EXIT_BY_SIGNAL + interruptSignal();
}

void declare(Command& command, PrintedFollow& options)
{
  addArmOptions(command, options, options.json);
  command.add("--mode", options.mode_name, "input of the twin: the recorded current, motion, or both")
      .choice({ "motion", "observer", "torque" });
  command.add("--out", options.out, "every row, measured and predicted; of an arm a directory, a file for each joint")
      .type("FILE.csv|DIR");
  command
      .add("--bag", options.bag,
           "the topics of the node beside a robot, with the forces on every tooth; of a bag its own messages too")
      .type("OUT.bag")
      .bag();
}

const Subcommand FOLLOW{ Subject::RECORDING, "follow",
                         "runs a healthy joint on a recording: measured and predicted motion and current", declare,
                         runFollow };
}  // namespace
}  // namespace hjt
