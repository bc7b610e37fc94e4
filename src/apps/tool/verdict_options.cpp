// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tool/verdict_options.hpp"

#include "output/exit_code.hpp"

namespace hjt
{
void addVerdictOptions(Command& command, ComparisonOptions& options, std::string& fail_on)
{
  command
      .add("--reference", options.references, "earlier reports of this joint or arm in sound condition, for comparison")
      .follow()
      .type("DIR")
      .existingDirectory();
  command
      .add("--fail-on", fail_on,
           "exit code 3 if the verdict is this or worse, 4 if nothing can be judged; else the verdict changes none")
      .choice({ "warn", "error" });
}

int exitCodeOf(const std::string& fail_on, HealthLevel health, bool is_judged)
{
  if (fail_on.empty())
  {
    return EXIT_DONE;
  }
  const HealthLevel least = fail_on == "warn" ? HealthLevel::WARN : HealthLevel::ERROR;
  return health >= least ? EXIT_DEPARTS : is_judged ? EXIT_DONE : EXIT_NOT_JUDGED;
}
}  // namespace hjt
