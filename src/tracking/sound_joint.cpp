// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/sound_joint.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>

#include <yaml-cpp/yaml.h>

#include "base/csv_table.hpp"
#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "health/baseline_file.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
/// Reads a file of a report as YAML, because JSON files are valid YAML.
YAML::Node readData(const std::string& directory, const char* name)
{
  const std::string path = directory + "/" + name;
  if (!std::filesystem::exists(path))
  {
    throw InputError(directory + " lacks " + name + ", a file of a report of `joint_twin compare`");
  }
  try
  {
    return YAML::LoadFile(path);
  }
  catch (const YAML::Exception& error)
  {
    throw InputError(path + " does not hold data of `joint_twin compare`: " + error.what());
  }
}

/// Reads the numbers `names` of a comparison. A number is NaN if it is null in the file, or if an older file lacks it.
template <std::size_t N>
std::array<double, N> readNumbers(const std::string& directory, const std::array<const char*, N>& names)
{
  const YAML::Node object = readData(directory, COMPARISON_FILE);
  const std::string refusal = directory + "/" + COMPARISON_FILE + " does not hold data of `joint_twin compare`: ";
  if (!object.IsMap() || !object["compliance_ratio"])
  {
    throw InputError(refusal + "it has no compliance_ratio");
  }
  std::array<double, N> numbers{};
  for (std::size_t i = 0; i < N; ++i)
  {
    const YAML::Node value = object[names[i]];
    try
    {
      numbers[i] = value && !value.IsNull() ? yamlNumber(value) : std::numeric_limits<double>::quiet_NaN();
    }
    catch (const YAML::Exception& error)
    {
      throw InputError(refusal + names[i] + ": " + error.what());
    }
  }
  return numbers;
}

std::vector<FrictionPoint> readFriction(const std::string& directory)
{
  std::vector<FrictionPoint> points;
  NumberTable<4> friction(directory + "/" + FRICTION_FILE, { "speed", "measured", "twin", "rows" });
  std::array<double, 4> row{};
  while (friction.read(row))
  {
    points.push_back({ row[0], row[1], 0.0, row[2], static_cast<std::uint64_t>(row[3]), 0.0 });
  }
  return points;
}
}  // namespace

std::string armOfReport(const std::string& directory)
{
  const YAML::Node report = readData(directory, ARM_FILE);
  if (!report.IsMap() || !report["arm"] || !report["arm"].IsScalar())
  {
    throw InputError(directory + "/" + ARM_FILE + " does not hold data of `joint_twin compare`: it has no arm");
  }
  return report["arm"].Scalar();
}

SoundJoint readSoundJoint(const std::vector<std::string>& directories, const Parameters& parameters)
{
  SoundJoint sound;
  if (directories.empty())
  {
    return sound;
  }
  std::vector<SoundFriction> frictions;
  double compliances = 0.0;
  double temperatures = 0.0;
  for (const std::string& directory : directories)
  {
    const auto [compliance, temperature, friction_deviation] =
        readNumbers<3>(directory, { "compliance_ratio", "temperature", "friction_deviation" });
    compliances += compliance;
    temperatures += temperature;
    if (std::isfinite(friction_deviation))  // otherwise the recording did not show the friction
    {
      frictions.push_back({ readFriction(directory), friction_deviation });
    }
    const std::string baseline = directory + "/" + BASELINE_FILE;
    if (sound.baseline.empty() && std::filesystem::exists(baseline))
    {
      try
      {
        sound.baseline = readBaseline(baseline, parameters, false);
      }
      catch (const InputError& error)
      {
        throw InputError("the reference " + directory + " does not fit this arm and gear: " + error.what());
      }
    }
  }
  const auto count = static_cast<double>(directories.size());
  sound.own = ownReference(frictions);
  sound.own.is_unjudged = frictions.empty();
  sound.own.compliance_ratio = compliances / count;
  sound.own.temperature = temperatures / count;
  return sound;
}
}  // namespace hjt
