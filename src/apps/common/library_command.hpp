// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/common/configuration.hpp"
#include "output/process_end.hpp"
#include "output/progress.hpp"

namespace hjt
{
/// Options of a function of a library, on the command line.
template <class Options>
struct Printed : Options
{
  bool json{};  ///< the result is printed as one document
};

/// The function's own options, and `--json`.
template <class Options>
void declarePrinted(OptionTable& table, Printed<Options>& options)
{
  addOptions(table, static_cast<Options&>(options));
  addJsonOption(table, options.json);
}

/// Progress and notices on stderr, of a command that writes no file: a signal ends its process at once.
Watch readingWatch();
/// As `readingWatch`; signals that end the process otherwise stop the function, as long as it is kept.
Watch consoleWatch();

/// Gives the result of FUNCTION to PRINT, which gives the exit code. A signal ends FUNCTION; PARTS: what it has by then
/// is printed too.
template <auto FUNCTION, auto PRINT, bool PARTS, class Options>
int runWatched(const Options& given)
{
  Options options = given;
  options.watch = consoleWatch();
  const auto result = FUNCTION(options);
  const int stopped = interruptSignal() != 0 ? EXIT_BY_SIGNAL + interruptSignal() : EXIT_DONE;
  const int code = stopped == EXIT_DONE || PARTS ? PRINT(options, result) : stopped;
  return stopped == EXIT_DONE ? code : stopped;
}
}  // namespace hjt
