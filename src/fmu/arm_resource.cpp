// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/arm_resource.hpp"

#include "arm/arm_file.hpp"
#include "base/joined.hpp"
#include "base/number_text.hpp"
#include "params/field_reader.hpp"

namespace hjt::fmu
{
namespace
{
constexpr Range ANY{ -1e300, 1e300 };

/// All values of an arm by their keys, for a reader or a writer.
template <class Arm, class Fields>
void visitArm(Arm& arm, Fields& fields)
{
  fields("gravity", "m/s^2", arm.gravity, ANY, "in the frame of the base");
  fields("payload_mass", "kg", arm.payload.mass, ANY, "at the tip");
  fields("payload_centre", "m", arm.payload.centre, ANY, "of its mass");
  fields("state_rate", "Hz", arm.state_rate, ANY, "of the controller's states");
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    const std::string place = "joints." + std::to_string(i) + '.';
    auto& joint = arm.joints[i];
    fields(place + "name", joint.short_name, "of its variables");
    fields(place + "speed_limit", "rad/s", joint.speed_limit, ANY, "0: none");
    fields(place + "feedback_limit", "N.m", joint.feedback_limit, ANY, "0: none");
    fields(place + "delay", "s", joint.delay, ANY, "of its set points");
    fields(place + "position", "1/s", joint.gains->position, ANY, "gain");
    fields(place + "speed", "N.m.s/rad", joint.gains->speed, ANY, "gain");
    fields(place + "integral_time", "s", joint.gains->integral_time, ANY, "of the speed's control");
    fields(place + "coulomb", "N.m", joint.gains->coulomb, ANY, "fed forward");
    fields(place + "viscous", "N.m.s/rad", joint.gains->viscous, ANY, "fed forward");
  }
  for (std::size_t i = 0; i < arm.links.size(); ++i)
  {
    const std::string place = "links." + std::to_string(i) + '.';
    auto& link = arm.links[i];
    fields(place + "motion", "-", link.motion, "of its joint");
    fields(place + "axis", "-", link.axis, ANY, "of its joint");
    fields(place + "origin", "m", link.origin, ANY, "of its joint");
    fields(place + "position", "m", link.position, ANY, "of its frame");
    fields(place + "rotation", "-", link.rotation, ANY, "of its frame");
    fields(place + "mass", "kg", link.mass, ANY, "of the link");
    fields(place + "centre", "m", link.centre, ANY, "of its mass");
    fields(place + "inertia", "kg.m^2", link.inertia, ANY, "about its centre");
  }
}

constexpr Range MOTIONS{ 0.0, static_cast<double>(LinkMotion::SLIDES) };

struct Reader
{
  template <class Field>
  void operator()(const std::string& key, const char* unit, Field& field, const Range& range, const char* meaning)
  {
    fields(key, unit, field, range, meaning);
  }
  void operator()(const std::string& key, std::string& field, const char* meaning) { fields(key, field, meaning); }
  void operator()(const std::string& key, const char* unit, LinkMotion& motion, const char* meaning)
  {
    int number = 0;
    fields(key, unit, number, MOTIONS, meaning);
    motion = static_cast<LinkMotion>(number);
  }

  FieldReader fields;
};

/// Lines of YAML, a list of maps for what has numbers in its key.
struct Writer
{
  void operator()(const std::string& key, const char*, double value, const Range&, const char*)
  {
    line(key, numberText(value));
  }
  template <std::size_t N>
  void operator()(const std::string& key, const char*, const std::array<double, N>& values, const Range&, const char*)
  {
    line(key, '[' + joined(values, ", ", numberText) + ']');
  }
  void operator()(const std::string& key, const std::string& value, const char*) { line(key, '"' + value + '"'); }
  void operator()(const std::string& key, const char*, LinkMotion motion, const char*)
  {
    line(key, std::to_string(static_cast<int>(motion)));
  }

  void line(const std::string& key, const std::string& value)
  {
    const std::size_t list = key.find('.');
    if (list == std::string::npos)
    {
      text += key + ": " + value + '\n';
      return;
    }
    const std::size_t name = key.rfind('.');
    const std::string item = key.substr(0, name);
    text += item.substr(0, list) == last.substr(0, list) ? "" : item.substr(0, list) + ":\n";
    text += (item == last ? "    " : "  - ") + key.substr(name + 1) + ": " + value + '\n';
    last = item;
  }

  std::string text;
  std::string last;  // item that is being written
};

std::size_t countOf(const ParameterMap& map, const std::string& list, const std::string& key)
{
  std::size_t count = 0;
  while (map.count(list + '.' + std::to_string(count) + '.' + key) != 0)
  {
    ++count;
  }
  return count;
}
}  // namespace

std::string armResource(const ArmDescription& arm)
{
  Writer writer;
  visitArm(arm, writer);
  return writer.text;
}

ArmDescription readArmResource(const std::string& path)
{
  const ParameterMap map = readArmFile(path);
  ArmDescription arm;
  arm.origin = ARM_FILE;
  arm.joints.resize(countOf(map, "joints", "name"));
  arm.links.resize(countOf(map, "links", "mass"));
  for (ArmJoint& joint : arm.joints)
  {
    joint.gains.emplace();
  }
  Reader reader{ FieldReader(map, path) };
  visitArm(arm, reader);
  reader.fields.refuseUnknownKeys();
  throwIfAny(reader.fields.errors());
  for (ArmJoint& joint : arm.joints)
  {
    joint.name = joint.short_name;
  }
  return arm;
}
}  // namespace hjt::fmu
