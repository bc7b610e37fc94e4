// SPDX-License-Identifier: BSD-3-Clause
#include "twin/configuration_options.hpp"

#include "harmonic_joint_twin/base/errors.hpp"
#include "params/configuration_files.hpp"

namespace hjt
{
namespace fs = std::filesystem;

void addOptions(OptionTable& table, ConfigurationOptions& options)
{
  table.add("--config", options.configs, "YAML overlay over the default configuration; repeatable, later wins")
      .type("FILE")
      .group(COMMON_GROUP);
  table.add("--set", options.assignments, "one parameter, over all files; repeatable, later wins")
      .type("section.key=value")
      .group(COMMON_GROUP);
  table.add("--config-dir", options.config_dir, "directory of the default configuration [or HJT_CONFIG_DIR]")
      .type("DIR")
      .group(COMMON_GROUP);
}

void addOptions(OptionTable& table, ConfigurationOptions& options, bool& force)
{
  addOptions(table, options);
  table.flag("--force", force, "overwrite existing output files").group(COMMON_GROUP);
}

void addFaultOption(OptionTable& table, ConfigurationOptions& options)
{
  table
      .add("--fault", options.faults,
           "a fault of the gear in addition to the configured ones, see `joint_twin faults`; repeatable")
      .type("KIND:SEVERITY[:PLACE[:ONSET]]");
}

fs::path configDirectory(const ConfigurationOptions& options)
{
  return configurationDirectory(options.config_dir);
}

ParameterMap defaultParameterMap(const ConfigurationOptions& options)
{
  ParameterMap map;
  readDefaultConfiguration(configDirectory(options).string(), map);
  return map;
}

void readOverlay(const ConfigurationOptions& options, const std::string& name, ParameterMap& map)
{
  readYamlFile(findConfiguration(name, configDirectory(options)), map);
}

void addOverlays(const ConfigurationOptions& options, ParameterMap& map)
{
  for (const std::string& overlay : options.configs)
  {
    readOverlay(options, overlay, map);
  }
  for (const std::string& assignment : options.assignments)
  {
    readAssignment(assignment, map);
  }
  if (options.values.count(faultKey(0) + ".kind") > 0)
  {
    eraseFaults(map);
  }
  putOver(options.values, map);
  if (!options.config_dir.empty())
  {
    findNamedFiles(configDirectory(options), map);
  }
}

ParameterMap loadParameterMap(const ConfigurationOptions& options)
{
  ParameterMap map = defaultParameterMap(options);
  addOverlays(options, map);
  return map;
}

void addFaults(const ConfigurationOptions& options, Parameters& parameters)
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

Parameters loadParameters(const ConfigurationOptions& options)
{
  Parameters parameters = parseParameters(loadParameterMap(options));
  addFaults(options, parameters);
  return parameters;
}
}  // namespace hjt
