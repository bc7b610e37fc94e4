// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <string>
#include <vector>

#include "apps/common/motion_options.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/text_table.hpp"
#include "recordings/identify.hpp"

namespace hjt
{
namespace
{
struct Options : Printed<IdentifyOptions>
{
  std::vector<double> train_pair;
  std::vector<double> judge_pair;
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

int run(const Options& given)
{
  Options options = given;
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

void declare(Command& command, Options& options)
{
  addArmOptions(command, options, options.json);
  command.add("--out", options.out, "the overlay; of an arm a directory, an overlay for each joint")
      .type("FILE.yaml|DIR");
  command
      .add("--train", options.train_pair, "from,to: part to identify on; default: the first third, of an arm all [s]")
      .pair();
  command.add("--judge", options.judge_pair, "from,to: part to test on; default: the rest, of an arm all [s]").pair();
  command
      .add("--folds", options.folds,
           "cuts the part to identify on into this many pieces and predicts each from the others; of an arm 5 by "
           "default")
      .range(2, 100);
}

const Subcommand IDENTIFY{
  Subject::RECORDING, "identify",
  "gain, friction, inertia and ripple of a joint from its recorded motion and current, as an overlay", declare, run
};
}  // namespace
}  // namespace hjt
