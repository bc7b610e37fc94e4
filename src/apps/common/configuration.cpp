// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/configuration.hpp"

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <regex>

#include "harmonic_joint_twin/base/errors.hpp"
#include "params/configuration_files.hpp"
#include "statics/gear_checks.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* GROUP = "Common options";
}  // namespace

void addFaultOption(Command& command, CommonOptions& options)
{
  command
      .add("--fault", options.faults,
           "a fault of the gear in addition to the configured ones, see `joint_twin faults`; repeatable")
      .type("KIND:SEVERITY[:PLACE[:ONSET]]");
}

void addConfigurationOptions(Command& command, CommonOptions& options)
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

void addCommonOptions(Command& command, CommonOptions& options)
{
  addConfigurationOptions(command, options);
  command.flag("--json", options.json, "one JSON document on stdout and nothing else there").group(GROUP);
  command.flag("--force", options.force, "overwrite existing output files").group(GROUP);
}

void addNamespaceOption(Command& command, std::string& joint_namespace)
{
  command.add("--joint-namespace", joint_namespace, "of the twin's topics")
      .type("NAME")
      .check(
          [](const std::string& name)
          {
            return std::regex_match(name, std::regex("(/[A-Za-z][A-Za-z0-9_]*)+")) ?
                       std::string() :
                       "'" + name + "' is not a global ROS name such as /joint_twin";
          });
}

fs::path configDirectory(const CommonOptions& options)
{
  if (!options.config_dir.empty())
  {
    setenv("HJT_CONFIG_DIR", options.config_dir.c_str(), 1);  // files that parameters name lie there too
  }
  return configurationDirectory("");
}

ParameterMap defaultParameterMap(const CommonOptions& options)
{
  ParameterMap map;
  readDefaultConfiguration(configDirectory(options).string(), map);
  return map;
}

void readOverlay(const CommonOptions& options, const std::string& name, ParameterMap& map)
{
  readYamlFile(findConfiguration(name, configDirectory(options)), map);
}

void addOverlays(const CommonOptions& options, ParameterMap& map)
{
  for (const std::string& overlay : options.configs)
  {
    readOverlay(options, overlay, map);
  }
  for (const std::string& assignment : options.assignments)
  {
    readAssignment(assignment, map);
  }
}

ParameterMap loadParameterMap(const CommonOptions& options)
{
  ParameterMap map = defaultParameterMap(options);
  addOverlays(options, map);
  return map;
}

void addFaults(const CommonOptions& options, Parameters& parameters)
{
  for (const std::string& fault : options.faults)
  {
    parameters.faults.push_back(parseFault(fault, parameters));
  }
  if (parameters.faults.size() > MAX_FAULTS)
  {
    throw ParameterError("--fault: more than " + std::to_string(MAX_FAULTS) + " faults");
  }
}

Parameters loadParameters(const CommonOptions& options)
{
  Parameters parameters = parseParameters(loadParameterMap(options));
  addFaults(options, parameters);
  return parameters;
}

void printGearWarnings(const Parameters& parameters)
{
  for (const std::string& warning : gearWarnings(parameters))
  {
    std::cerr << "joint_twin: warning: " << warning << '\n';
  }
}

Parameters loadGear(const CommonOptions& options)
{
  Parameters parameters = loadParameters(options);
  printGearWarnings(parameters);
  return parameters;
}
}  // namespace hjt
