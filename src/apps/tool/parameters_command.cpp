// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "apps/common/configuration.hpp"
#include "output/exit_code.hpp"
#include "output/json.hpp"

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
                // Numbers come as (unit, value, range, meaning), all else as (value, meaning).
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
  table.flag("--markdown", options.markdown, "the table of keys, ranges and meanings instead");
  addCommonOptions(table, options);
}

const Subcommand PARAMETERS{ Subject::DATA_SET, "parameters", "all parameters in force, with unit and meaning", declare,
                             describe };
}  // namespace
}  // namespace hjt
