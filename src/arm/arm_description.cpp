// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_description.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <sstream>

#include <yaml-cpp/yaml.h>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
std::string textOf(const std::filesystem::path& path)
{
  std::ifstream file(path);
  std::stringstream text;
  if (!file || !(text << file.rdbuf()))
  {
    throw ParameterError(path.string() + " cannot be read, or is empty");
  }
  return text.str();
}

std::string beside(const std::filesystem::path& path, const std::string& name)
{
  return (path.parent_path() / name).string();
}

/// The file's map; the description as found from here.
YAML::Node load(const std::string& path)
{
  try
  {
    YAML::Node root = YAML::Load(textOf(path));
    const YAML::Node& read = root;
    if (read.IsMap() && read["description"] && read["description"].IsScalar())
    {
      root["description"] = beside(path, read["description"].Scalar());
    }
    return root;
  }
  catch (const YAML::Exception& error)
  {
    throw ParameterError(path + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

/// `base` with the keys of `over`, whose `like` has named it.
YAML::Node overlaid(YAML::Node base, const YAML::Node& over)
{
  for (const auto& entry : over)
  {
    if (entry.first.Scalar() != "like")
    {
      base[entry.first.Scalar()] = entry.second;
    }
  }
  return base;
}

/// One map of the file; `place` is its name in error texts.
class Section
{
public:
  Section(std::string place, const YAML::Node& node, std::initializer_list<const char*> keys)
    : place_(std::move(place)), node_(node)
  {
    if (!node.IsMap())
    {
      throw ParameterError(place_ + ": keys and values expected");
    }
    for (const auto& entry : node)
    {
      const auto& key = entry.first.Scalar();
      if (std::none_of(keys.begin(), keys.end(), [&](const char* known) { return key == known; }))
      {
        throw ParameterError(place_ + ": unknown key '" + key + "'");
      }
    }
  }

  YAML::Node at(const char* key) const
  {
    const YAML::Node value = node_[key];
    if (!value || value.IsNull())
    {
      throw ParameterError(place_ + ": " + key + " is missing");
    }
    return value;
  }

  template <class T>
  T value(const char* key) const
  {
    try
    {
      return at(key).as<T>();
    }
    catch (const YAML::Exception&)
    {
      throw ParameterError(place_ + ": " + key + " is not of the form expected");
    }
  }

  bool has(const char* key) const { return node_[key].IsDefined(); }
  const std::string& place() const { return place_; }

private:
  std::string place_;
  YAML::Node node_;
};

ArmJoint readJoint(const std::string& place, const YAML::Node& node)
{
  const Section section(place, node, { "name", "short_name", "overlays", "parameters", "limits", "check_up" });
  ArmJoint joint;
  joint.name = section.value<std::string>("name");
  joint.short_name = section.value<std::string>("short_name");
  joint.overlays = section.value<std::vector<std::string>>("overlays");
  for (const auto& entry : section.at("parameters"))
  {
    joint.parameters.push_back(entry.first.Scalar() + "=" + entry.second.Scalar());
  }
  if (section.has("limits"))
  {
    const Section limits(place + ": limits", section.at("limits"), { "speed", "torque" });
    joint.speed_limit = limits.value<double>("speed");
    joint.torque_limit = limits.value<double>("torque");
  }
  if (section.has("check_up"))
  {
    joint.check_up = section.value<std::vector<double>>("check_up");
  }
  return joint;
}

/// The file's map over that of the file that it is like, and so on.
YAML::Node loadWhole(const std::string& path, int depth = 0)
{
  constexpr int MAX_DEPTH = 8;
  const YAML::Node root = load(path);
  const Section own(path, root, { "like", "description", "base", "tip", "gravity", "payload", "joints" });
  if (!own.has("like"))
  {
    return root;
  }
  if (depth == MAX_DEPTH)
  {
    throw ParameterError(path + ": like: more than " + std::to_string(MAX_DEPTH) + " files in a row");
  }
  return overlaid(loadWhole(beside(path, own.value<std::string>("like")), depth + 1), root);
}
}  // namespace

ArmDescription readArmDescription(const std::string& path)
{
  const YAML::Node root = loadWhole(path);
  const Section section(path, root, { "description", "base", "tip", "gravity", "payload", "joints" });
  ArmDescription arm;
  arm.origin = path;
  arm.urdf = textOf(section.value<std::string>("description"));
  arm.base = section.value<std::string>("base");
  arm.tip = section.value<std::string>("tip");
  arm.gravity = section.value<std::array<double, 3>>("gravity");
  const Section payload(path + ": payload", section.at("payload"), { "mass", "centre" });
  arm.payload.mass = payload.value<double>("mass");
  arm.payload.centre = payload.value<std::array<double, 3>>("centre");
  for (const auto& node : section.at("joints"))
  {
    arm.joints.push_back(readJoint(path + ": joint " + std::to_string(arm.joints.size()), node));
  }
  if (arm.joints.empty())
  {
    throw ParameterError(path + ": joints is an empty list");
  }
  for (const ArmJoint& joint : arm.joints)
  {
    if (!joint.check_up.empty() && joint.check_up.size() != arm.joints.size())
    {
      throw ParameterError(path + ": check_up of " + joint.name + " must have an angle for each joint");
    }
  }
  return arm;
}
}  // namespace hjt
