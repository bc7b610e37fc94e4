// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_configuration.hpp"

#include <algorithm>
#include <numeric>
#include <system_error>

#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/configuration_files.hpp"

namespace hjt
{
namespace fs = std::filesystem;

namespace
{
/// Returns the file that the link `file` leads to if link and file are in the same directory. The link is then another
/// name of the file's arm. Returns none if `file` is no link, or if it leads to another directory.
std::optional<fs::path> namesakeOf(const fs::path& file)
{
  std::error_code error;
  const fs::path target = fs::read_symlink(file, error);
  return error || target.has_parent_path() ? std::nullopt : std::optional(file.parent_path() / target);
}
}  // namespace

std::string mainName(const std::string& name, const fs::path& directory)
{
  const std::optional<fs::path> namesake = namesakeOf(directory / "arms" / (name + ".yaml"));
  return namesake ? namesake->stem().string() : name;
}

std::string findArm(const std::string& name, const fs::path& directory)
{
  std::error_code error;
  if (fs::exists(name, error) && !fs::is_directory(name, error))
  {
    return name;
  }
  const fs::path shipped = directory / "arms" / (mainName(name, directory) + ".yaml");
  if (!fs::exists(shipped, error))
  {
    throw ParameterError("arm " + name + " is neither a file nor an arm in " + shipped.parent_path().string());
  }
  return shipped.string();
}

std::vector<fs::path> armFiles(const fs::path& directory)
{
  std::vector<fs::path> files;
  std::error_code error;  // prevents an exception if `directory` has no folder arms
  for (const fs::directory_entry& entry : fs::directory_iterator(directory / "arms", error))
  {
    if (entry.path().extension() == ".yaml" && !namesakeOf(entry.path()))
    {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> jointNames(const ArmDescription& arm)
{
  std::vector<std::string> names;
  for (const ArmJoint& joint : arm.joints)
  {
    names.push_back(joint.name);
  }
  return names;
}

std::vector<std::string> armsLike(const ArmDescription& arm, const fs::path& directory)
{
  std::vector<std::string> names;
  for (const fs::path& file : armFiles(directory))
  {
    if (jointNames(readArmDescription(file.string())) == jointNames(arm))
    {
      names.push_back(file.stem().string());
    }
  }
  return names;
}

std::optional<std::size_t> findJoint(const ArmDescription& arm, const std::string& name)
{
  const auto found = std::find_if(arm.joints.begin(), arm.joints.end(),
                                  [&](const ArmJoint& each) { return each.short_name == name || each.name == name; });
  return found == arm.joints.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - arm.joints.begin()));
}

std::string shortNames(const ArmDescription& arm)
{
  return joined(arm.joints, ", ", [](const ArmJoint& each) { return each.short_name; });
}

ParameterMap armJointParameters(const ArmJoint& joint, const fs::path& directory, const std::string& identified)
{
  ParameterMap map;
  readDefaultConfiguration(directory.string(), map);
  for (const std::string& overlay : joint.overlays)
  {
    readYamlFile(findConfiguration(overlay, directory), map);
  }
  putOver(joint.parameters, map);
  map["joint.name"].value = joint.name;
  map["telemetry.load"].value = std::string("arm");
  if (!identified.empty())
  {
    readYamlFile((fs::path(identified) / (joint.short_name + ".yaml")).string(), map);
  }
  return map;
}

ParameterMap armDriveParameters(const ArmJoint& joint, const fs::path& directory, const std::string& identified)
{
  constexpr const char* ROTOR = "motor.rotor_inertia";
  ParameterMap map = armJointParameters(joint, directory, identified);
  if (!identified.empty())
  {
    const ParameterMap configured = armJointParameters(joint, directory, {});
    const auto inertia_of = [](const ParameterMap& drive) { return parseParameters(drive).motor.rotor_inertia; };
    if (inertia_of(map) < inertia_of(configured))
    {
      map[ROTOR] = configured.at(ROTOR);
    }
  }
  return map;
}

std::vector<ParameterMap> armDriveMaps(const ArmDescription& arm, const ConfigurationOptions& options,
                                       const std::string& identified)
{
  constexpr const char* SCENE = "solver.scene";
  std::vector<ParameterMap> maps;
  ParameterMap defaults;
  readDefaultConfiguration(configDirectory(options), defaults);
  for (const ArmJoint& joint : arm.joints)
  {
    maps.push_back(armDriveParameters(joint, configDirectory(options), identified));
    if (maps.back().at(SCENE).origin == defaults.at(SCENE).origin)
    {
      readAssignment(std::string(SCENE) + "=auto", maps.back());
    }
    addOverlays(options, maps.back());
  }
  return maps;
}

void addIdentifiedGains(const std::string& identified, ArmDescription& arm)
{
  const fs::path path = fs::path(identified) / GAINS_FILE;
  std::error_code error;
  if (!identified.empty() && fs::exists(path, error))
  {
    readGains(path.string(), arm);
  }
}

std::vector<std::size_t> driverOrder(const ArmDescription& arm)
{
  std::vector<std::size_t> order(arm.joints.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return arm.joints[a].name < arm.joints[b].name; });
  return order;
}

std::vector<std::string> driverNames(const ArmDescription& arm)
{
  std::vector<std::string> names;
  for (const std::size_t joint : driverOrder(arm))
  {
    names.push_back(arm.joints[joint].name);
  }
  return names;
}

void giveOwnSeeds(std::vector<Parameters>& drives)
{
  constexpr int SEEDS = 100'000;                   // number of allowed values of a pitch seed [-]
  constexpr std::int64_t NOISE_SEEDS = 1LL << 31;  // number of allowed values of sensors.noise_seed [-]
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    int& noise = drives[i].sensors.noise_seed;
    noise = static_cast<int>((noise + static_cast<std::int64_t>(i)) % NOISE_SEEDS);
    ManufactureParameters& errors = drives[i].manufacture;
    for (PitchParameters* pitch : { &errors.flexspline_pitch, &errors.circular_spline_pitch })
    {
      // Without pitch deviations the seed has no effect and stays, so that joints can share a response surface.
      if (pitch->deviation > 0.0)
      {
        pitch->seed = (pitch->seed + 2 * static_cast<int>(i)) % SEEDS;
      }
    }
  }
}

void addArmFaults(const ArmDescription& arm, const std::vector<std::string>& faults, std::vector<Parameters>& drives)
{
  std::vector<ConfigurationOptions> of_joints(arm.joints.size());
  for (const std::string& fault : faults)
  {
    const std::size_t colon = fault.find(':');
    const std::optional<std::size_t> joint = findJoint(arm, fault.substr(0, colon));
    if (colon == std::string::npos || !joint)
    {
      throw ParameterError("fault " + fault + ": expected JOINT:KIND:SEVERITY[:PLACE[:ONSET]], where JOINT is one of " +
                           shortNames(arm));
    }
    of_joints[*joint].faults.push_back(fault.substr(colon + 1));
  }
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    addFaults(of_joints[i], drives[i]);
  }
}

std::vector<Parameters> armDrives(const ArmDescription& arm, const ConfigurationOptions& options,
                                  const std::string& identified, const std::vector<std::string>& faults)
{
  std::vector<Parameters> drives;
  for (const ParameterMap& map : armDriveMaps(arm, options, identified))
  {
    drives.push_back(parseParameters(map));
  }
  giveOwnSeeds(drives);
  addArmFaults(arm, faults, drives);
  return drives;
}
}  // namespace hjt
