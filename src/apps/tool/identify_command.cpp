// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "apps/common/motion_options.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/text_table.hpp"
#include "recordings/identify.hpp"
#include "recordings/identify_controller.hpp"

namespace hjt
{
namespace
{
struct PrintedIdentify : Printed<IdentifyOptions>
{
  std::vector<double> train_pair;
  std::vector<double> judge_pair;
  bool controller{};
};

void print(const IdentifyReport& report, bool json)
{
  if (json || report.errors.empty())
  {
    const Report whole = report.whole();
    printReport(json, whole.lines, whole.tables);
    return;
  }
  // The errors are a block of their own: its values are long, the names above are.
  printReport(false, report.values.lines);
  std::cout << '\n';
  printReport(false, report.errors);
  if (!report.refused.empty())
  {
    std::cout << "\nnot identifiable from this motion:\n";
    for (const std::string& line : report.refused)
    {
      printWrapped(line, 2);
    }
  }
}

std::optional<Span> spanOf(const std::vector<double>& pair)
{
  return pair.empty() ? std::nullopt : std::make_optional(Span{ pair[0], pair[1] });
}

int runOfController(const PrintedIdentify& options)
{
  if (!options.train_pair.empty() || !options.judge_pair.empty() || options.folds != 0)
  {
    throw InputError("--controller takes all rows: none of --train, --judge and --folds");
  }
  if (options.load != LOAD_OF_ARM)
  {
    throw InputError("--controller takes target_moment of the recording: no --load");
  }
  const std::vector<IdentifiedController> joints = identifyController(options, options.out);
  const Report report = reportOf(joints);
  printReport(options.json, report.lines, report.tables);
  const bool any = std::any_of(joints.begin(), joints.end(),
                               [](const IdentifiedController& joint) { return joint.fit.refusal.empty(); });
  return any ? EXIT_DONE : EXIT_FAILED;
}

int runIdentify(const PrintedIdentify& given)
{
  if (given.controller)
  {
    return runOfController(given);
  }
  PrintedIdentify options = given;
  options.train = spanOf(options.train_pair);
  options.judge = spanOf(options.judge_pair);
  options.watch = consoleWatch();
  const Identified identified = identify(options);
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  print(reportOf(identified), options.json);
  return identified.any ? EXIT_DONE : EXIT_FAILED;
}

void declare(Command& command, PrintedIdentify& options)
{
  addArmOptions(command, options, options.json);
  command.add("--out", options.out, "the overlay; of an arm a directory, an overlay for each joint")
      .type("FILE.yaml|DIR");
  command
      .add("--train", options.train_pair, "from,to: part to identify on; default: the first third, of an arm all [s]")
      .pair();
  command.add("--judge", options.judge_pair, "of one joint, from,to: part to test on; default: the rest [s]").pair();
  command
      .add("--folds", options.folds,
           "cuts the part to identify on into this many pieces and predicts each from the others; of an arm 5 by "
           "default")
      .range(2, 100);
  command
      .flag("--controller", options.controller,
            "in place of the drives: gains of the arm's controller, from a table that holds target and actual of all "
            "joints, into DIR/controller.yaml, which `joint_twin arm --identified DIR` takes")
      .needs("--arm");
}

const Subcommand IDENTIFY{
  Subject::RECORDING, "identify",
  "gain, friction, inertia and ripple of a joint from its recorded motion and current, as an overlay", declare,
  runIdentify
};
}  // namespace
}  // namespace hjt
