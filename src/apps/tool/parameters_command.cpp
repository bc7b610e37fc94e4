// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "apps/common/configuration.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/tool/commands.hpp"

#include "params/choices.hpp"
#include "params/field_table.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

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
                Json& entry = json[key.substr(0, key.find('.'))][key.substr(key.find('.') + 1)];
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
    std::cout << parameterTableMarkdown();
    return EXIT_DONE;
  }
  const Parameters parameters = loadParameters(options);
  std::cout << (options.json ? toJson(parameters).dump(2) + "\n" : describeParameters(parameters));
  return EXIT_DONE;
}
}  // namespace

void addParametersCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<ParametersOptions>();
  auto* command = app.add_subcommand("parameters", "all parameters in force, with unit and meaning");
  auto* markdown = command->add_flag("--markdown", options->markdown, "the table of keys, ranges and meanings instead");
  addCommonOptions(*command, *options);
  command->get_option("--json")->excludes(markdown);
  command->callback([options, &exit_code] { exit_code = describe(*options); });
}
}  // namespace hjt
