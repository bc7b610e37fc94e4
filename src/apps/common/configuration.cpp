// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/configuration.hpp"

#include <iostream>
#include <regex>

#include "statics/gear_checks.hpp"

namespace hjt
{
namespace
{
constexpr const char* GROUP = "Common options";
}  // namespace

void addFaultOption(Command& command, ConfigurationOptions& options)
{
  command
      .add("--fault", options.faults,
           "a fault of the gear in addition to the configured ones, see `joint_twin faults`; repeatable")
      .type("KIND:SEVERITY[:PLACE[:ONSET]]");
}

void addConfigurationOptions(Command& command, ConfigurationOptions& options)
{
  command.add("--config", options.configs, "YAML overlay over the default configuration; repeatable, later wins")
      .type("FILE")
      .group(GROUP);
  command.add("--set", options.assignments, "one parameter, over all files; repeatable, later wins")
      .type("section.key=value")
      .group(GROUP);
  command.add("--config-dir", options.config_dir, "directory of the default configuration [or HJT_CONFIG_DIR]")
      .type("DIR")
      .group(GROUP);
}

void addCommonOptions(Command& command, ConfigurationOptions& options, bool& json, bool& force)
{
  addConfigurationOptions(command, options);
  command.flag("--json", json, "one JSON document on stdout and nothing else there").group(GROUP);
  command.flag("--force", force, "overwrite existing output files").group(GROUP);
}

void addCommonOptions(Command& command, CommonOptions& options)
{
  addCommonOptions(command, options, options.json, options.force);
}

void addNamespaceOption(Command& command, std::string& joint_namespace)
{
  command.add("--joint-namespace", joint_namespace, "ROS namespace of the twin's topics")
      .type("NAME")
      .check(
          [](const std::string& name)
          {
            return std::regex_match(name, std::regex("(/[A-Za-z][A-Za-z0-9_]*)+")) ?
                       std::string() :
                       "'" + name + "' is not a global ROS name such as /joint_twin";
          });
}

void printGearWarnings(const Parameters& parameters)
{
  for (const std::string& warning : gearWarnings(parameters))
  {
    std::cerr << "joint_twin: warning: " << warning << '\n';
  }
}

Parameters loadGear(const ConfigurationOptions& options)
{
  Parameters parameters = loadParameters(options);
  printGearWarnings(parameters);
  return parameters;
}

Parameters loadAnalysed(const ConfigurationOptions& options, Analysis analysis)
{
  Parameters parameters = loadGear(options);
  requireFaultsAct(parameters, analysis);
  return parameters;
}
}  // namespace hjt
