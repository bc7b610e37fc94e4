// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "apps/common/configuration.hpp"
#include "output/process_end.hpp"
#include "output/progress.hpp"

namespace hjt
{
/// Options of a library function on the command line.
template <class Options>
struct Printed : Options
{
  bool json{};  ///< print the result as one document
};

/// Adds the function's options and `--json`.
template <class Options>
void declarePrinted(OptionTable& table, Printed<Options>& options)
{
  addOptions(table, static_cast<Options&>(options));
  addJsonOption(table, options.json);
}

/// Watch with progress and notices on stderr, for a command that writes no file: a signal ends its process at once.
Watch readingWatch();
/// Watch like `readingWatch`; during its lifetime signals stop the function instead of the process.
Watch consoleWatch();

/// Passes the result of FUNCTION to PRINT, which returns the exit code. A signal ends FUNCTION. PARTS: an incomplete
/// result is printed too.
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
