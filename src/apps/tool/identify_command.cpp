// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "apps/common/library_command.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/text_table.hpp"
#include "recordings/identify.hpp"
#include "recordings/identify_controller.hpp"

namespace hjt
{
namespace
{
struct PrintedIdentify : Printed<IdentifyOptions>
{
  bool controller{};
};

int printIdentified(const PrintedIdentify& options, const Identified& identified)
{
  const IdentifyReport report = reportOf(identified);
  const int code = identified.any ? EXIT_DONE : EXIT_FAILED;
  if (options.json || report.errors.empty())
  {
    const Report whole = report.whole();
    printReport(options.json, whole.lines, whole.tables);
    return code;
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
  return code;
}

int runOfController(const PrintedIdentify& options)
{
  if (options.train || options.judge || options.folds != 0)
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

/// The overload of a recording.
Identified identifyRecorded(const IdentifyOptions& options)
{
  return identify(options);
}

int runIdentify(const PrintedIdentify& options)
{
  return options.controller ? runOfController(options) :
                              runWatched<identifyRecorded, printIdentified, false, PrintedIdentify>(options);
}

void declare(OptionTable& table, PrintedIdentify& options)
{
  declarePrinted<IdentifyOptions>(table, options);
  table
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
