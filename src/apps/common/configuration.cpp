// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/configuration.hpp"

#include <cstdlib>
#include <filesystem>
#include <regex>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* GROUP = "Common options";

/// List of the default configuration's files, in their directory.
constexpr const char* STAGES = "stages";

fs::path findConfigDirectory(const CommonOptions& options)
{
  if (!options.config_dir.empty())
  {
    return options.config_dir;
  }
  if (const char* from_environment = std::getenv("HJT_CONFIG_DIR"))
  {
    return from_environment;
  }
  return packageDirectory() / "config";
}

/// As given, else beside the default configuration: `config/x.yaml` and `joints/x.yaml` work from anywhere.
fs::path findOverlay(const std::string& name, const fs::path& config_directory)
{
  for (const fs::path& candidate : { fs::path(name), config_directory.parent_path() / name, config_directory / name })
  {
    if (fs::exists(candidate))
    {
      return candidate;
    }
  }
  return name;
}
}  // namespace

fs::path packageDirectory()
{
  // PREFIX/lib/harmonic_joint_twin/joint_twin belongs to PREFIX/share/harmonic_joint_twin.
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = executable.parent_path() / "../../share/harmonic_joint_twin";
  return fs::exists(installed / "config" / STAGES) ? installed.lexically_normal() : fs::path(HJT_SOURCE_DIR);
}

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
  fs::path directory = findConfigDirectory(options);
  if (!fs::exists(directory / STAGES))
  {
    throw ParameterError("no default configuration in '" + directory.string() +
                         "': name its directory with --config-dir or HJT_CONFIG_DIR");
  }
  return directory;
}

ParameterMap defaultParameterMap(const CommonOptions& options)
{
  ParameterMap map;
  readDefaultConfiguration(configDirectory(options).string(), map);
  return map;
}

void readOverlay(const CommonOptions& options, const std::string& name, ParameterMap& map)
{
  readYamlFile(findOverlay(name, fs::absolute(configDirectory(options))).string(), map);
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
}  // namespace hjt
