// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/arm_variables.hpp"

#include <utility>

#include "arm/arm_description.hpp"
#include "arm/arm_recorder.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "params/field_reader.hpp"

namespace hjt::fmu
{
namespace
{
constexpr Range ANY{ -1e300, 1e300 };

/// Calls `fields` with key, unit, value, range and meaning of each value of an arm. `fields` reads or writes the value.
template <class Arm, class Fields>
void visitArm(Arm& arm, Fields& fields)
{
  fields("gravity", "m/s^2", arm.gravity, ANY, "acceleration of gravity in the frame of the base");
  fields("payload_mass", "kg", arm.payload.mass, ANY, "mass of the payload at the tip");
  fields("payload_centre", "m", arm.payload.centre, ANY, "centre of mass of the payload in the frame of the tip");
  fields("state_rate", "Hz", arm.state_rate, ANY, "rate at which the controller states its signals");
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    const std::string place = "joints." + std::to_string(i) + '.';
    auto& joint = arm.joints[i];
    fields(place + "name", joint.short_name, "prefix of the names of the joint's variables");
    fields(place + "speed_limit", "rad/s", joint.speed_limit, ANY, "largest speed of the joint; 0: no limit");
    fields(place + "feedback_limit", "N.m", joint.feedback_limit, ANY,
           "largest torque of the feedback at the joint; 0: no limit");
    fields(place + "delay", "s", joint.delay, ANY, "time from a set point to the reaction of the joint's controller");
    fields(place + "position", "1/s", joint.gains->position, ANY, "wanted speed / angle error of the joint");
    fields(place + "speed", "N.m.s/rad", joint.gains->speed, ANY, "torque / speed error of the joint");
    fields(place + "integral_time", "s", joint.gains->integral_time, ANY, "integral time of the speed controller");
    fields(place + "coulomb", "N.m", joint.gains->coulomb, ANY, "Coulomb friction in the feedforward");
    fields(place + "viscous", "N.m.s/rad", joint.gains->viscous, ANY,
           "coefficient of viscous friction in the feedforward");
  }
  for (std::size_t i = 0; i < arm.links.size(); ++i)
  {
    const std::string place = "links." + std::to_string(i) + '.';
    auto& link = arm.links[i];
    fields(place + "motion", "-", link.motion, "kind of motion of the joint");
    fields(place + "axis", "-", link.axis, ANY, "axis of the joint in the frame of the link before the joint");
    fields(place + "origin", "m", link.origin, ANY, "point on this axis in the frame of the link before the joint");
    fields(place + "position", "m", link.position, ANY,
           "origin of the link's frame in the frame of the link before the joint, at a joint angle of 0");
    fields(place + "rotation", "-", link.rotation, ANY,
           "rotation matrix of the link's frame in the frame of the link before the joint, row by row");
    fields(place + "mass", "kg", link.mass, ANY, "mass of the link");
    fields(place + "centre", "m", link.centre, ANY, "centre of mass in the link's frame");
    fields(place + "inertia", "kg.m^2", link.inertia, ANY, "inertia of the link about its centre of mass");
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

/// Writes lines of YAML. A key that contains a number becomes an item of a list of maps.
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
  std::string last;  // list item of the last written key
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

constexpr Range ANGLES{ -100.0, 100.0 };  // allowed angles of a joint [rad]

std::vector<double> gainsOf(const ArmDescription& arm, double JointGains::*gain)
{
  std::vector<double> gains;
  for (const ArmJoint& joint : arm.joints)
  {
    gains.push_back((*joint.gains).*gain);
  }
  return gains;
}

void addArmInputs(const ArmDescription& arm, std::vector<FmuVariable>& all)
{
  const auto add =
      [&](const char* name, const char* unit, const char* meaning, std::vector<double> start, const Range& range)
  {
    const bool is_array = start.size() > 1;
    all.push_back({ name, unit, meaning, Causality::INPUT, Type::FLOAT64, { std::move(start) }, range, is_array });
  };
  constexpr double WRENCH = 1000.0;  // largest component of a force or moment, as on the node's ~wrench [N], [N.m]
  const std::vector<double> zeros(arm.joints.size(), 0.0);
  add("target_q", "rad", "angles of the joints' set points at the end of the step", zeros, ANGLES);
  add("target_qd", "rad/s", "speeds of the joints' set points at the end of the step", zeros, { -100.0, 100.0 });
  add("target_qdd", "rad/s^2", "accelerations of the joints' set points at the end of the step", zeros, { -1e6, 1e6 });
  add("wrench_force", "N", "external force on the tip, in the frame of the base", { 0.0, 0.0, 0.0 },
      { -WRENCH, WRENCH });
  add("wrench_moment", "N.m", "external moment on the tip, in the frame of the base", { 0.0, 0.0, 0.0 },
      { -WRENCH, WRENCH });
  add("payload_mass", "kg", "mass of the payload at the tip; the controller knows this mass", { arm.payload.mass },
      hjt::PAYLOAD_MASS);
  add("payload_centre", "m", "centre of mass of the payload in the frame of the tip",
      { arm.payload.centre.begin(), arm.payload.centre.end() }, { -100.0, 100.0 });
}

void addArmOutputs(std::size_t joints, std::vector<FmuVariable>& all)
{
  const auto add = [&](const char* name, const char* unit, const char* meaning, std::size_t size, Type type) {
    all.push_back({ name, unit, meaning, Causality::OUTPUT, type, { std::vector<double>(size, 0.0) }, {}, size > 1 });
  };
  for (std::size_t k = TARGET_CURRENT; k < ARM_QUANTITIES.size(); ++k)
  {
    const ArmQuantity& quantity = ARM_QUANTITIES[k];
    add(quantity.name, quantity.unit, quantity.meaning, quantity.width(joints), Type::FLOAT64);
  }
  add("tool_orientation", "-", "true orientation of the tip in the frame of the base, unit quaternion x, y, z, w", 4,
      Type::FLOAT64);
  add("tool_error", "m", "distance of the tool from its position at the set points", 1, Type::FLOAT64);
  add("protective_stop", "-", "0: no protective stop; otherwise number of the joint that caused the stop, base = 1", 1,
      Type::INT32);
}

void addArmParameters(const ArmDescription& arm, std::vector<FmuVariable>& all)
{
  const auto add =
      [&](const char* name, const char* unit, const char* meaning, std::vector<double> start, const Range& range)
  {
    const bool is_array = start.size() > 1;
    all.push_back({ name, unit, meaning, Causality::PARAMETER, Type::FLOAT64, { std::move(start) }, range, is_array });
  };
  add("start_q", "rad", "angles of the joints at the start", std::vector<double>(arm.joints.size(), 0.0), ANGLES);
  all.push_back({ "controller.on",
                  "-",
                  "true: the arm follows the set points; false: the motors get motor_torque of the joints",
                  Causality::PARAMETER,
                  Type::BOOLEAN,
                  { { 1.0 } } });
  add("gravity", "m/s^2", "acceleration of gravity in the frame of the base",
      { arm.gravity.begin(), arm.gravity.end() }, { -100.0, 100.0 });
  add("controller.position", "1/s", "wanted speed / angle error of a joint", gainsOf(arm, &JointGains::position),
      { 0.0, 1e3 });
  add("controller.speed", "N.m.s/rad", "torque / speed error of a joint", gainsOf(arm, &JointGains::speed),
      { 0.0, 1e6 });
  add("controller.integral_time", "s", "integral time of the speed controller",
      gainsOf(arm, &JointGains::integral_time), { 1e-3, 1e6 });
  add("controller.coulomb", "N.m", "Coulomb friction in the feedforward", gainsOf(arm, &JointGains::coulomb),
      { -1e4, 1e4 });
  add("controller.viscous", "N.m.s/rad", "coefficient of viscous friction in the feedforward",
      gainsOf(arm, &JointGains::viscous), { -1e4, 1e4 });
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

std::string prefixOf(const ArmJoint& joint)
{
  return joint.short_name + '.';
}

std::vector<FmuVariable> armVariables(const ArmDescription& arm, const std::vector<Parameters>& drives)
{
  std::vector<FmuVariable> all{ timeVariable() };
  addArmInputs(arm, all);
  addArmOutputs(arm.joints.size(), all);
  addArmParameters(arm, all);
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    addDrive(drives[i], prefixOf(arm.joints[i]), all);
  }
  return all;
}
}  // namespace hjt::fmu
