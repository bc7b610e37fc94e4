// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/configuration.hpp"

#include <cstdlib>
#include <filesystem>

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

void addFaultOption(CLI::App& command, CommonOptions& options)
{
  command
      .add_option("--fault", options.faults,
                  "a fault of the gear beside the configured ones, see `joint_twin faults`; repeatable")
      ->type_name("KIND:SEVERITY[:PLACE[:ONSET]]")
      ->allow_extra_args(false);
}

void addConfigurationOptions(CLI::App& command, CommonOptions& options)
{
  command
      .add_option("--config", options.configs, "YAML overlay over the default configuration; repeatable, later wins")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(GROUP);
  command.add_option("--set", options.assignments, "one parameter, over all files; repeatable, later wins")
      ->type_name("section.key=value")
      ->allow_extra_args(false)
      ->group(GROUP);
  command.add_option("--config-dir", options.config_dir, "directory of the default configuration [or HJT_CONFIG_DIR]")
      ->type_name("DIR")
      ->group(GROUP);
}

void addCommonOptions(CLI::App& command, CommonOptions& options)
{
  addConfigurationOptions(command, options);
  command.add_flag("--json", options.json, "one JSON document on stdout and nothing else there")->group(GROUP);
  command.add_flag("--force", options.force, "overwrite existing output files")->group(GROUP);
}

ParameterMap loadParameterMap(const CommonOptions& options)
{
  const fs::path directory = findConfigDirectory(options);
  if (!fs::exists(directory / STAGES))
  {
    throw ParameterError("no default configuration in '" + directory.string() +
                         "': name its directory with --config-dir or HJT_CONFIG_DIR");
  }
  ParameterMap map;
  readDefaultConfiguration(directory.string(), map);
  for (const std::string& overlay : options.configs)
  {
    readYamlFile(findOverlay(overlay, fs::absolute(directory)).string(), map);
  }
  for (const std::string& assignment : options.assignments)
  {
    readAssignment(assignment, map);
  }
  return map;
}

void addFaults(const CommonOptions& options, Parameters& parameters)
{
  for (const std::string& fault : options.faults)
  {
    parameters.faults.push_back(parseFault(fault, parameters));
  }
  if (parameters.faults.size() > MOST_FAULTS)
  {
    throw ParameterError("--fault: more than " + std::to_string(MOST_FAULTS) + " faults");
  }
}

Parameters loadParameters(const CommonOptions& options)
{
  Parameters parameters = parseParameters(loadParameterMap(options));
  addFaults(options, parameters);
  return parameters;
}
}  // namespace hjt
