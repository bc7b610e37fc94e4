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
           "exit code 3 if the verdict is this or worse, 4 if nothing can be judged; with not-judged 3 for a warning "
           "and 4 for a joint that is not judged. Without it the verdict changes none")
      .choice({ "warn", "error", "not-judged" });
}

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

std::string headlineOf(const std::string& level, bool is_judged, std::size_t not_judged, std::size_t joints)
{
  return level + (is_judged && not_judged > 0 ?
                      ", but " + std::to_string(not_judged) + " of " + std::to_string(joints) + " joints not judged" :
                      "");
}
}  // namespace hjt
