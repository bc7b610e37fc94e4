// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <iostream>
#include <string>

#include "apps/common/motion_options.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/text_table.hpp"
#include "recordings/compare.hpp"
#include "recordings/trend.hpp"
#include "recordings/trend_report.hpp"

namespace hjt
{
namespace
{
/// Options of a function that judges.
template <class Options>
struct Judging : Printed<Options>
{
  std::string fail_on;  ///< warn, error or not-judged; empty: the exit code is no verdict
};

/// `--reference` and `--fail-on`.
void addVerdictOptions(Command& command, ComparisonOptions& options, std::string& fail_on)
{
  command
      .add("--reference", options.references, "earlier reports of this joint or arm in sound condition, for comparison")
      .follow()
      .type("DIR")
      .existingDirectory();
  command
      .add("--fail-on", fail_on,
           "exit code 3 if the verdict is this or worse, 4 if nothing can be judged; with not-judged 3 for a warning "
           "and 4 for a joint that is not judged. Without it the verdict changes none")
      .choice({ "warn", "error", "not-judged" });
}

/// Exit code of the process for a verdict. `not_judged`: joints that are not judged.
int exitCodeOf(const std::string& fail_on, HealthLevel health, bool is_judged, std::size_t not_judged)
{
  if (fail_on.empty())
  {
    return EXIT_DONE;
  }
  const HealthLevel least = fail_on == "error" ? HealthLevel::ERROR : HealthLevel::WARN;
  const bool is_enough = is_judged && (fail_on != "not-judged" || not_judged == 0);
  return health >= least ? EXIT_DEPARTS : is_enough ? EXIT_DONE : EXIT_NOT_JUDGED;
}

/// The level, and for how many joints it does not speak.
std::string headlineOf(const std::string& level, bool is_judged, std::size_t not_judged, std::size_t joints)
{
  return level + (is_judged && not_judged > 0 ?
                      ", but " + std::to_string(not_judged) + " of " + std::to_string(joints) + " joints not judged" :
                      "");
}

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

using JudgedTrend = Judging<TrendOptions>;

void print(const Trend& trend)
{
  constexpr std::size_t NARROW = 0;
  std::cout << headlineOf(trend.level, trend.is_judged, trend.not_judged, trend.joints.size()) << '\n';
  printWrapped(trend.text, 0);
  std::cout << '\n';
  recordingsOf(trend).print(NARROW);
  std::cout << '\n';
  jointsOf(trend).print(NARROW);
  std::cout << '\n';
  for (const DatedRecording& recording : trend.recordings)
  {
    if (!recording.isRead() || !recording.compared.is_judged || recording.compared.health != HealthLevel::OK)
    {
      printWrapped(recording.path + ": " + recording.level() + ". " + recording.text(), 0);
    }
  }
}

int runTrend(const JudgedTrend& given)
{
  JudgedTrend options = given;
  options.watch = consoleWatch();
  const Trend found = trend(options);
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  if (options.json)
  {
    std::cout << documentOf(found).dump() << '\n';
    return exitCodeOf(options.fail_on, found.health, found.is_judged, found.not_judged);
  }
  print(found);
  for (const std::string& written : { options.out, found.page })
  {
    std::cout << (written.empty() ? "" : "written: " + written + "\n");
  }
  return exitCodeOf(options.fail_on, found.health, found.is_judged, found.not_judged);
}

void declare(Command& command, JudgedTrend& options)
{
  command
      .add("recordings", options.recordings,
           "recordings as of compare, or folders of them, of one joint or arm over months")
      .required()
      .type("IN|DIR");
  addJointOptions(command, options, options.json);
  command.add("--out", options.out, "CSV with a row for each recording").type("FILE.csv");
  command.add("--report", options.report, "directory of a page with the figure, and its data").type("DIR");
  addVerdictOptions(command, options, options.fail_on);
}

const Subcommand TREND{ Subject::RECORDING, "trend",
                        "friction of each joint over the recordings of months: whether it changes. The verdict is the "
                        "worse of that and the latest recording's",
                        declare, runTrend };
}  // namespace
}  // namespace hjt
