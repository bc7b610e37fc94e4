// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "apps/common/configuration.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/tool/commands.hpp"

namespace hjt
{
namespace
{
int faults(const CommonOptions& options)
{
  const Parameters parameters = loadParameters(options);
  if (options.json)
  {
    nlohmann::ordered_json kinds = nlohmann::ordered_json::array();
    for (const FaultDescription& kind : FAULT_DESCRIPTIONS)
    {
      kinds.push_back({ { "kind", kind.name },
                        { "severity_1", kind.severity },
                        { "place", placeName(kind.place) },
                        { "first_place", firstPlace(kind.kind) },
                        { "last_place", lastPlace(kind.kind, parameters) },
                        { "shows", shownFirst(kind.kind, parameters) } });
    }
    std::cout << kinds.dump(2) << '\n';
    return EXIT_DONE;
  }
  std::cout << "| kind | severity 1 | place | shows first in |\n|---|---|---|---|\n";
  for (const FaultDescription& kind : FAULT_DESCRIPTIONS)
  {
    std::cout << "| `" << kind.name << "` | " << kind.severity << " | " << placeText(kind.kind, parameters) << " | "
              << shownFirst(kind.kind, parameters) << " |\n";
  }
  return EXIT_DONE;
}
}  // namespace

void addFaultsCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<CommonOptions>();
  auto* command = app.add_subcommand("faults", "list the kinds of faults: what severity 1 is, places, where they show");
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = faults(*options); });
}
}  // namespace hjt
