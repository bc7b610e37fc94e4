// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <string>
#include <vector>

#include "apps/common/configuration.hpp"
#include "output/exit_code.hpp"
#include "output/report.hpp"
#include "output/text_table.hpp"

namespace hjt
{
namespace
{
int faults(const CommonOptions& options)
{
  const Parameters parameters = loadParameters(options);
  const std::vector<Column<FaultDescription>> columns{
    { "kind", [](const FaultDescription& kind) { return kind.name; } },
    { "severity_1", [](const FaultDescription& kind) { return kind.severity; } },
    { "place", [](const FaultDescription& kind) { return placeName(kind.place); } },
    { "first_place", [](const FaultDescription& kind) { return firstPlace(kind.kind); } },
    { "last_place", [&](const FaultDescription& kind) { return lastPlace(kind.kind, parameters); } },
    { "shows", [&](const FaultDescription& kind) { return shownFirst(kind.kind, parameters); } }
  };
  if (options.json)
  {
    std::cout << Table(columns, FAULT_DESCRIPTIONS).rows().dump() << '\n';
    return EXIT_DONE;
  }
  for (const FaultDescription& kind : FAULT_DESCRIPTIONS)
  {
    std::cout << kind.name << '\n';
    printWrapped("severity 1: " + std::string(kind.severity), 2);
    printWrapped("place:      " + placeText(kind.kind, parameters), 2);
    printWrapped("shows in:   " + shownFirst(kind.kind, parameters), 2);
  }
  return EXIT_DONE;
}

const Subcommand LIST_OF_FAULTS{ Subject::JOINT, "faults",
                                 "list the kinds of faults: size of severity 1, places, symptoms", addCommonOptions,
                                 faults };
}  // namespace
}  // namespace hjt
