// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <string>
#include <vector>

#include "apps/common/configuration.hpp"
#include "output/json.hpp"
#include "output/process_end.hpp"
#include "output/report.hpp"
#include "params/choices.hpp"
#include "params/field_table.hpp"

namespace hjt
{
namespace
{
struct ParametersOptions : CommonOptions
{
  bool markdown{};
};

Json toJson(const Parameters& parameters)
{
  Json json;
  visitFields(parameters,
              [&](const std::string& key, const auto& first, const auto& second, const auto&... rest)
              {
                Json& entry = json[key];
                // Arguments after the key: unit, value, range and meaning of a number; value and meaning of others.
                if constexpr (std::is_enum_v<std::decay_t<decltype(first)>>)
                {
                  for (const auto& [name, choice] : choiceNames(first))
                  {
                    if (choice == first)
                    {
                      entry = name;
                    }
                  }
                }
                else if constexpr (sizeof...(rest) == 0)
                {
                  entry = first;
                }
                else
                {
                  entry = second;
                }
              });
  return json;
}

int describe(const ParametersOptions& options)
{
  if (options.markdown)
  {
    if (options.json)
    {
      std::cerr << "joint_twin: --markdown and --json exclude each other\n";
      return EXIT_USAGE;
    }
    std::cout << parameterTableMarkdown();
    return EXIT_DONE;
  }
  const Parameters parameters = loadParameters(options);
  std::cout << (options.json ? toJson(parameters).dump() + "\n" : describeParameters(parameters));
  return EXIT_DONE;
}

void declare(OptionTable& table, ParametersOptions& options)
{
  table.flag("--markdown", options.markdown, "print a Markdown table of keys, ranges and meanings instead of YAML");
  addCommonOptions(table, options);
}

const Subcommand PARAMETERS{ Subject::DATA_SET, "parameters", "print all parameters with value, unit and meaning",
                             declare, describe };

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
                                 "list the kinds of faults: size at severity 1, places, symptoms", addCommonOptions,
                                 faults };
}  // namespace
}  // namespace hjt
