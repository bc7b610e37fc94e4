// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_description.hpp"

#include <algorithm>
#include <cctype>

#include "arm/arm_file.hpp"
#include "base/number_text.hpp"
#include "params/field_reader.hpp"

namespace hjt
{
namespace
{
constexpr double LARGEST_ANGLE = 6.283185307179586;  // a turn either way, as a UR's joints [rad]

/// Whether there is `key`, or one below it.
bool holds(const ParameterMap& map, const std::string& key)
{
  const auto below = map.lower_bound(key + ".");
  return map.count(key) != 0 || (below != map.end() && below->first.rfind(key + ".", 0) == 0);
}

/// Takes out of the map what is below `key`, under the rest of its keys.
ParameterMap takeBelow(ParameterMap& map, const std::string& key)
{
  const std::string prefix = key + ".";
  ParameterMap taken;
  for (auto entry = map.lower_bound(prefix); entry != map.end() && entry->first.rfind(prefix, 0) == 0;)
  {
    taken[entry->first.substr(prefix.size())] = entry->second;
    entry = map.erase(entry);
  }
  return taken;
}

/// As ROS allows a name that is neither a path nor anonymous.
bool isBaseName(const std::string& name)
{
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  return !name.empty() && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c)
                     { return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '_'; });
}

void readGains(const std::string& place, FieldReader& fields, JointGains& gains)
{
  fields(place + ".position", "1/s", gains.position, Range{ 0.0, 1e3 }, "speed wanted for an error of the angle");
  fields(place + ".speed", "N.m.s/rad", gains.speed, Range{ 0.0, 1e6 }, "torque for an error of the speed");
  fields(place + ".integral_time", "s", gains.integral_time, Range{ 1e-3, 1e6 }, "of the speed's control");
  fields(place + ".coulomb", "N.m", gains.coulomb, Range{ -1e4, 1e4 }, "friction that is fed forward, constant");
  fields(place + ".viscous", "N.m.s/rad", gains.viscous, Range{ -1e4, 1e4 }, "and by speed");
}

/// Reads the joints one after the other.
class JointReader
{
public:
  JointReader(ParameterMap& map, FieldReader& fields) : map_(map), fields_(fields) {}

  void read(const std::string& place, std::size_t joints, ArmJoint& joint)
  {
    fields_(place + ".name", joint.name, "of the joint in the messages and in the URDF");
    readShortName(place + ".short_name", joint.short_name);
    readOverlays(place + ".overlays", joint.overlays);
    if (isMapOrNone(place + ".parameters"))
    {
      joint.parameters = takeBelow(map_, place + ".parameters");
    }
    if (isMapOrNone(place + ".limits") && holds(map_, place + ".limits"))
    {
      fields_(place + ".limits.speed", "rad/s", joint.speed_limit, Range{ 1e-3, 100.0 }, "greatest speed");
      fields_(place + ".limits.torque", "N.m", joint.torque_limit, Range{ 1e-3, 1e6 }, "greatest torque at the output");
      if (holds(map_, place + ".limits.feedback"))
      {
        fields_(place + ".limits.feedback", "N.m", joint.feedback_limit, Range{ 1e-3, 1e6 },
                "greatest torque of the controller beyond what it feeds forward");
      }
    }
    if (holds(map_, place + ".delay"))
    {
      fields_(place + ".delay", "s", joint.delay, Range{ 0.0, 0.1 }, "of a set point until the controller acts on it");
    }
    if (isMapOrNone(place + ".controller") && holds(map_, place + ".controller"))
    {
      readGains(place + ".controller", fields_, joint.gains.emplace());
    }
    if (holds(map_, place + ".check_up"))
    {
      joint.check_up.resize(joints);
      fields_(place + ".check_up", "rad", joint.check_up, Range{ -LARGEST_ANGLE, LARGEST_ANGLE },
              "angles of all joints where its check-up begins");
    }
  }

private:
  void readShortName(const std::string& key, std::string& name)
  {
    fields_(key, name, "of files and namespaces");
    if (name.empty())
    {
      return;
    }
    const auto other = std::find_if(short_names_.begin(), short_names_.end(),
                                    [&](const auto& before) { return before.second == name; });
    if (!isBaseName(name))
    {
      fields_.refuse(key, "a name: a letter, then letters, digits and underscores");
    }
    else if (other != short_names_.end())
    {
      fields_.refuse(key, "another than " + other->first);
    }
    short_names_.emplace_back(key, name);
  }

  void readOverlays(const std::string& key, std::vector<std::string>& overlays)
  {
    const auto whole = map_.find(key);
    if (whole != map_.end())
    {
      const auto* numbers = std::get_if<std::vector<double>>(&whole->second.value);
      if (numbers == nullptr || !numbers->empty())
      {
        fields_.refuse(key, "a list of configuration files");
      }
      map_.erase(whole);
    }
    for (std::string one = key + ".0"; map_.count(one) != 0; one = key + "." + std::to_string(overlays.size()))
    {
      overlays.emplace_back();
      fields_(one, overlays.back(), "a configuration file");
    }
  }

  /// Otherwise it is refused, and taken out of the map.
  bool isMapOrNone(const std::string& key)
  {
    if (map_.count(key) == 0)
    {
      return true;
    }
    fields_.refuse(key, "keys and values");
    map_.erase(key);
    return false;
  }

  ParameterMap& map_;
  FieldReader& fields_;
  std::vector<std::pair<std::string, std::string>> short_names_;  // key and name of the joints so far
};
}  // namespace

std::string payloadErrors(const Payload& payload)
{
  // Written so that NaN is no number of a range.
  const auto is_within = [](double value, const Range& range) { return value >= range.min && value <= range.max; };
  if (!is_within(payload.mass, PAYLOAD_MASS))
  {
    return "mass = " + numberText(payload.mass) + " [kg] is out of range, allowed: " + rangeText(PAYLOAD_MASS);
  }
  for (const double coordinate : payload.centre)
  {
    if (!is_within(coordinate, PAYLOAD_CENTRE))
    {
      return "centre: " + numberText(coordinate) + " [m] is out of range, allowed: " + rangeText(PAYLOAD_CENTRE);
    }
  }
  return {};
}

ArmDescription readArmDescription(const std::string& path)
{
  ParameterMap map = readArmFile(path);
  FieldReader fields(map, path);
  ArmDescription arm;
  arm.origin = path;
  std::string description;
  fields("description", description, "URDF beside the file");
  fields("base", arm.base, "link that stands still");
  fields("tip", arm.tip, "link that carries the payload");
  fields("gravity", "m/s^2", arm.gravity, Range{ -100.0, 100.0 }, "in the frame of the base");
  fields("payload.mass", "kg", arm.payload.mass, PAYLOAD_MASS, "at the tip");
  fields("payload.centre", "m", arm.payload.centre, PAYLOAD_CENTRE, "of its mass, in the frame of the tip");
  if (holds(map, "state_rate"))
  {
    fields("state_rate", "Hz", arm.state_rate, Range{ 1.0, 1000.0 }, "of the controller's states");
  }
  const auto place = [](std::size_t joint) { return "joints." + std::to_string(joint); };
  std::size_t joints = 0;
  while (holds(map, place(joints)))
  {
    ++joints;
  }
  arm.joints.resize(std::max<std::size_t>(joints, 1));
  JointReader reader(map, fields);
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    reader.read(place(i), joints, arm.joints[i]);
  }
  fields.refuseUnknownKeys();
  throwIfAny(fields.errors());
  arm.urdf = textOf(description, map.at("description").origin + ": description: ");
  readLinks(arm);
  return arm;
}

void readGains(const std::string& path, ArmDescription& arm)
{
  const ParameterMap map = readArmFile(path);
  FieldReader fields(map, path);
  for (ArmJoint& joint : arm.joints)
  {
    if (holds(map, joint.short_name))
    {
      readGains(joint.short_name, fields, joint.gains.emplace());
    }
  }
  fields.refuseUnknownKeys();
  throwIfAny(fields.errors());
}
}  // namespace hjt
