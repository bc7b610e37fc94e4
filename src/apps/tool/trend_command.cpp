// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "apps/tool/verdict_options.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/text_table.hpp"
#include "recordings/trend.hpp"
#include "recordings/trend_report.hpp"

namespace hjt
{
namespace
{
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
