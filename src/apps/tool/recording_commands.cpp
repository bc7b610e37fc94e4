// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <iostream>
#include <string>
#include <vector>

#include "apps/common/library_command.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/report.hpp"
#include "recordings/compare.hpp"
#include "recordings/follow.hpp"
#include "recordings/identify.hpp"
#include "recordings/identify_controller.hpp"
#include "recordings/indicators.hpp"
#include "recordings/remaining.hpp"
#include "recordings/trend.hpp"

namespace hjt
{
namespace
{
using PrintedFollow = Printed<FollowOptions>;

int printFollowed(const PrintedFollow& options, const Followed& followed)
{
  if (!followed.joints.empty())
  {
    const Report report = reportOf(followed);
    printReport(options.json, report.lines, report.tables);
  }
  return EXIT_DONE;
}

const Subcommand FOLLOW{ Subject::RECORDING, "follow",
                         "run the twin of a sound joint along a recording: measured and predicted motion and current",
                         declarePrinted<FollowOptions>, runWatched<follow, printFollowed, true, PrintedFollow> };

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
                            "use of a recorded joint, and the life of a drive with this use",
                            declarePrinted<RemainingOptions>,
                            runWatched<remaining, printRemaining, false, PrintedRemaining> };

/// Options of a library function that gives a verdict.
template <class Options>
struct Judging : Printed<Options>
{
  std::string fail_on;  ///< warn, error or not-judged; empty: the exit code does not depend on the verdict
};

/// Adds the options of the library function, and `--json` and `--fail-on`.
template <class Options>
void declareJudging(OptionTable& table, Judging<Options>& options)
{
  declarePrinted<Options>(table, options);
  table
      .add("--fail-on", options.fail_on,
           "exit code 3 for this verdict or a worse one, and 4 if no joint can be judged. With not-judged: 3 for WARN "
           "or ERROR, otherwise 4 if a joint is not judged. Default: the exit code does not depend on the verdict")
      .choice({ "warn", "error", "not-judged" });
}

/// Exit code for the verdict in `found`, by the value of --fail-on.
template <class Judged>
int exitCodeOf(const std::string& fail_on, const Judged& found)
{
  if (fail_on.empty())
  {
    return EXIT_DONE;
  }
  const HealthLevel least = fail_on == "error" ? HealthLevel::ERROR : HealthLevel::WARN;
  const bool is_enough = found.is_judged && (fail_on != "not-judged" || found.not_judged == 0);
  return found.health >= least ? EXIT_DEPARTS : is_enough ? EXIT_DONE : EXIT_NOT_JUDGED;
}

/// Text with the level of the verdict and the number of joints that are not judged.
template <class Judged>
std::string headlineOf(const Judged& found)
{
  return found.level + (found.is_judged && found.not_judged > 0 ?
                            ", but " + std::to_string(found.not_judged) + " of " + std::to_string(found.joints.size()) +
                                " joints not judged" :
                            "");
}

using JudgedComparison = Judging<ComparisonOptions>;

void printArm(const ComparedRecording& compared)
{
  std::cout << headlineOf(compared) << '\n';
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
                       { "", "measured - predicted current, rms", joint.residual_rms, "A" } });
}

int printCompared(const JudgedComparison& options, const ComparedRecording& compared)
{
  if (options.json)
  {
    std::cout << compared.document.dump() << '\n';
    return exitCodeOf(options.fail_on, compared);
  }
  compared.is_arm ? printArm(compared) : printJoint(compared);
  if (!compared.page.empty())
  {
    std::cout << (compared.is_arm ? "\n" : "") << "written: " << compared.page << '\n';
  }
  return exitCodeOf(options.fail_on, compared);
}

const Subcommand COMPARE{ Subject::RECORDING, "compare",
                          "compare a recorded joint or arm with the twin: verdict, figures and data as a page",
                          declareJudging<ComparisonOptions>,
                          runWatched<compare, printCompared, false, JudgedComparison> };

using JudgedTrend = Judging<TrendOptions>;

void print(const Trend& trend)
{
  constexpr std::size_t NARROW = 0;
  std::cout << headlineOf(trend) << '\n';
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

int printTrend(const JudgedTrend& options, const Trend& found)
{
  if (options.json)
  {
    std::cout << documentOf(found).dump() << '\n';
    return exitCodeOf(options.fail_on, found);
  }
  print(found);
  for (const std::string& written : { options.out, found.page })
  {
    std::cout << (written.empty() ? "" : "written: " + written + "\n");
  }
  return exitCodeOf(options.fail_on, found);
}

const Subcommand TREND{ Subject::RECORDING, "trend",
                        "change of each joint's friction over recordings of months. The verdict is the worst of the "
                        "trends' verdicts and the verdict of the latest judged recording",
                        declareJudging<TrendOptions>, runWatched<trend, printTrend, false, JudgedTrend> };

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
  // The errors are a separate block, because their values are long and those of the block above are short.
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
    throw InputError("--controller uses all rows and excludes --train, --judge and --folds");
  }
  if (options.load != LOAD_OF_ARM)
  {
    throw InputError("--controller uses the recording's target_moment and excludes --load");
  }
  const std::vector<IdentifiedController> joints = identifyController(options, options.out);
  const Report report = reportOf(joints);
  printReport(options.json, report.lines, report.tables);
  const bool any = std::any_of(joints.begin(), joints.end(),
                               [](const IdentifiedController& joint) { return joint.fit.refusal.empty(); });
  return any ? EXIT_DONE : EXIT_FAILED;
}

/// Selects the overload of `identify` for a recording.
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
            "identify the gains of the arm's controller instead of the drives, from a table with target and actual "
            "values of all joints; the result is DIR/controller.yaml for `joint_twin arm --identified DIR`")
      .needs("--arm");
}

const Subcommand IDENTIFY{
  Subject::RECORDING, "identify",
  "gain, friction, inertia and ripple of a joint from its recorded motion and current, as an overlay", declare,
  runIdentify
};
}  // namespace
}  // namespace hjt
