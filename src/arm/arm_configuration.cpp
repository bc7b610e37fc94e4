// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_configuration.hpp"

#include <system_error>
#include <utility>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/configuration_files.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;
}  // namespace

std::string findArm(const std::string& name, const fs::path& directory)
{
  std::error_code error;
  if (fs::exists(name, error) && !fs::is_directory(name, error))
  {
    return name;
  }
  const fs::path shipped = directory / "arms" / (name + ".yaml");
  if (!fs::exists(shipped, error))
  {
    throw ParameterError("arm " + name + ": neither a file nor an arm in " + shipped.parent_path().string());
  }
  return shipped.string();
}

ParameterMap armJointParameters(const ArmJoint& joint, const fs::path& directory, const std::string& identified)
{
  ParameterMap map;
  readDefaultConfiguration(directory.string(), map);
  for (const std::string& overlay : joint.overlays)
  {
    readYamlFile(findConfiguration(overlay, directory), map);
  }
  for (const auto& [key, value] : joint.parameters)
  {
    map[key] = value;
  }
  map["joint.name"].value = joint.name;
  map["telemetry.load"].value = std::string("arm");
  if (!identified.empty())
  {
    readYamlFile((fs::path(identified) / (joint.short_name + ".yaml")).string(), map);
  }
  return map;
}

double takeInertiaInLoad(Parameters& parameters)
{
  const double ratio = nominalRatio(parameters.gear);
  return ratio * ratio * std::exchange(parameters.telemetry.inertia_in_load, 0.0);
}
}  // namespace hjt
