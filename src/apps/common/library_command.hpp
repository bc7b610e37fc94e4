// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/common/configuration.hpp"
#include "output/process_end.hpp"
#include "output/progress.hpp"

namespace hjt
{
/// Options of a library function and of the command that calls it.
template <class Options>
struct Printed : Options
{
  bool json{};  ///< whether to print the result as one JSON document
};

/// Adds the options of the library function, and `--json`.
template <class Options>
void declarePrinted(OptionTable& table, Printed<Options>& options)
{
  addOptions(table, static_cast<Options&>(options));
  addJsonOption(table, options.json);
}

/// Watch that prints progress and notices on stderr. A signal ends the process at once: the command writes no file.
Watch readingWatch();
/// Watch like `readingWatch`, but during its lifetime a signal ends the library function instead of the process.
Watch consoleWatch();

/// Passes the result of FUNCTION to PRINT, which returns the exit code. A signal ends FUNCTION. If PARTS is true, PRINT
/// also receives an incomplete result.
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
