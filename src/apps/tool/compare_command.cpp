// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <string>

#include "apps/common/motion_options.hpp"
#include "apps/tool/verdict_options.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/text_table.hpp"
#include "recordings/compare.hpp"

namespace hjt
{
namespace
{
using JudgedComparison = Judging<ComparisonOptions>;

void printArm(const ComparedRecording& compared)
{
  std::cout << headlineOf(compared.level, compared.is_judged, compared.not_judged, compared.joints.size()) << '\n';
  printWrapped(compared.text, 0);
  std::cout << '\n';
  tableOf(compared).print();
}

void printJoint(const ComparedRecording& compared)
{
  const ComparedJoint& joint = compared.joints.front();
  for (const ContentLine& line : joint.contents.lines)
  {
    printWrapped((line.found ? "found   " : "missing ") + line.name + " (" + line.gives + ")", 0);
  }
  std::cout << '\n' << compared.level << '\n';
  for (const Finding& finding : joint.verdict.findings)
  {
    printWrapped(subjectTitle(finding.subject) + (": " + std::string(levelName(finding.level))) + ". " +
                     findingText(joint.verdict, finding),
                 0);
  }
  std::cout << '\n';
  printReport(false, { { "", "rows", joint.rows },
                       { "", "duration", compared.found.duration, "s" },
                       { "", "current, rms", joint.current_rms, "A" },
                       { "", "measured less predicted current, rms", joint.residual_rms, "A" } });
}

int runCompare(const JudgedComparison& given)
{
  JudgedComparison options = given;
  options.watch = consoleWatch();
  const ComparedRecording compared = compare(options);
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  if (options.json)
  {
    std::cout << compared.document.dump() << '\n';
    return exitCodeOf(options.fail_on, compared.health, compared.is_judged, compared.not_judged);
  }
  compared.is_arm ? printArm(compared) : printJoint(compared);
  if (!compared.page.empty())
  {
    std::cout << (compared.is_arm ? "\n" : "") << "written: " << compared.page << '\n';
  }
  return exitCodeOf(options.fail_on, compared.health, compared.is_judged, compared.not_judged);
}

void declare(Command& command, JudgedComparison& options)
{
  addArmOptions(command, options, options.json);
  command
      .add("--report", options.report,
           "directory of the page, its figures and data; of an arm a directory for each joint; without it none is made")
      .type("DIR");
  addVerdictOptions(command, options, options.fail_on);
}

const Subcommand COMPARE{ Subject::RECORDING, "compare",
                          "compares a recorded joint or arm with the twin: verdict, figures and data as a page",
                          declare, runCompare };
}  // namespace
}  // namespace hjt
