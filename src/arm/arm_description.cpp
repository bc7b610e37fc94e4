// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_description.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <mutex>

#include <console_bridge/console.h>
#include <urdf/model.h>
#include <kdl/chain.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/field_reader.hpp"

namespace hjt
{
namespace
{
constexpr double LARGEST_ANGLE = 6.283185307179586;  // one turn to each side, the range of a UR's joints [rad]

/// Whether the map has `key` or a key below it.
bool holds(const ParameterMap& map, const std::string& key)
{
  const auto below = map.lower_bound(key + ".");
  return map.count(key) != 0 || (below != map.end() && below->first.rfind(key + ".", 0) == 0);
}

/// Moves the entries whose keys begin with `key` and a dot from the map to the result, without this beginning.
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

/// Whether ROS allows the name as that of a node or a namespace without a parent: letters, digits and underscores.
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
  fields(place + ".position", "1/s", gains.position, Range{ 0.0, 1e3 },
         "speed that the controller demands per error of the joint angle");
  fields(place + ".speed", "N.m.s/rad", gains.speed, Range{ 0.0, 1e6 },
         "torque of the controller per error of the joint speed");
  fields(place + ".integral_time", "s", gains.integral_time, Range{ 1e-3, 1e6 },
         "integral time of the control of the joint speed");
  fields(place + ".coulomb", "N.m", gains.coulomb, Range{ -1e4, 1e4 },
         "constant part of the friction that the controller feeds forward");
  fields(place + ".viscous", "N.m.s/rad", gains.viscous, Range{ -1e4, 1e4 },
         "friction that the controller feeds forward, per joint speed");
}

/// Reads the joints one after the other.
class JointReader
{
public:
  JointReader(ParameterMap& map, FieldReader& fields) : map_(map), fields_(fields) {}

  void read(const std::string& place, std::size_t joints, ArmJoint& joint)
  {
    fields_(place + ".name", joint.name, "name of the joint in the messages and in the URDF");
    readShortName(place + ".short_name", joint.short_name);
    readOverlays(place + ".overlays", joint.overlays);
    if (isMapOrNone(place + ".parameters"))
    {
      joint.parameters = takeBelow(map_, place + ".parameters");
    }
    if (isMapOrNone(place + ".limits") && holds(map_, place + ".limits"))
    {
      fields_(place + ".limits.speed", "rad/s", joint.speed_limit, Range{ 1e-3, 100.0 }, "largest speed of the joint");
      fields_(place + ".limits.torque", "N.m", joint.torque_limit, Range{ 1e-3, 1e6 }, "largest torque at the output");
      if (holds(map_, place + ".limits.feedback"))
      {
        fields_(place + ".limits.feedback", "N.m", joint.feedback_limit, Range{ 1e-3, 1e6 },
                "largest torque that the controller adds to the torque that it feeds forward");
      }
    }
    if (holds(map_, place + ".delay"))
    {
      fields_(place + ".delay", "s", joint.delay, Range{ 0.0, 0.1 },
              "time from a set point until the controller acts on it");
    }
    if (isMapOrNone(place + ".controller") && holds(map_, place + ".controller"))
    {
      readGains(place + ".controller", fields_, joint.gains.emplace());
    }
    if (holds(map_, place + ".check_up"))
    {
      joint.check_up.resize(joints);
      fields_(place + ".check_up", "rad", joint.check_up, Range{ -LARGEST_ANGLE, LARGEST_ANGLE },
              "angles of all joints at the start of this joint's check-up");
    }
  }

private:
  void readShortName(const std::string& key, std::string& name)
  {
    fields_(key, name, "name of the joint in files and namespaces");
    if (name.empty())
    {
      return;
    }
    const auto other = std::find_if(short_names_.begin(), short_names_.end(),
                                    [&](const auto& before) { return before.second == name; });
    if (!isBaseName(name))
    {
      fields_.refuse(key, "a name of letters, digits and underscores that begins with a letter");
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

  /// Returns true if `key` has no value of its own. Otherwise refuses the value and removes it from the map.
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
  std::vector<std::pair<std::string, std::string>> short_names_;  // key and short name of each joint read so far
};

/// Position of the '>' that ends the tag. A '>' within an attribute does not end the tag.
std::size_t endOfTag(const std::string& xml, std::size_t at)
{
  constexpr const char* ENDS = ">\"'";
  at = xml.find_first_of(ENDS, at);
  while (at != std::string::npos && xml[at] != '>')
  {
    const std::size_t closing = xml.find(xml[at], at + 1);
    at = closing == std::string::npos ? closing : xml.find_first_of(ENDS, closing + 1);
  }
  return at;
}

/// Largest depth to which elements are nested. The time of an XML parser may grow with the square of the depth.
std::size_t depthOf(const std::string& xml)
{
  std::size_t depth = 0;
  std::size_t deepest = 0;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at))
  {
    const auto begins = [&](const char* text) { return xml.compare(at, std::strlen(text), text) == 0; };
    const std::size_t last = begins("<!--")      ? xml.find("-->", at) :
                             begins("<![CDATA[") ? xml.find("]]>", at) :
                                                   endOfTag(xml, at);
    if (begins("</"))
    {
      depth -= depth > 0 ? 1 : 0;
    }
    else if (!begins("<!") && !begins("<?") && last != std::string::npos && xml[last - 1] != '/')
    {
      deepest = std::max(deepest, ++depth);
    }
    at = std::min(last, xml.size() - 1) + 1;
  }
  return deepest;
}

/// Keeps the first error of the URDF parser while this object exists. The object is needed because the parser only
/// reports numbers that it cannot read, and skips them.
class ParserErrors : public console_bridge::OutputHandler
{
public:
  ParserErrors() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  ~ParserErrors() override { console_bridge::restorePreviousOutputHandler(); }
  ParserErrors(const ParserErrors&) = delete;
  ParserErrors(ParserErrors&&) = delete;
  ParserErrors& operator=(const ParserErrors&) = delete;
  ParserErrors& operator=(ParserErrors&&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/, int /*line*/) override
  {
    if (first_.empty() && level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR)
    {
      first_ = text;
    }
  }

  const std::string& first() const { return first_; }  ///< first error; empty: no error

private:
  /// A lock is needed because all threads of the process share one handler of the parser's reports.
  static std::mutex& mutex()
  {
    static std::mutex of_handler;
    return of_handler;
  }

  std::lock_guard<std::mutex> lock_;
  std::string first_;
};

/// Parses the URDF of the arm. @throws ParameterError with the parser's first error.
void parse(const ArmDescription& arm, urdf::Model& model, KDL::Tree& tree)
{
  std::string error;
  bool is_read = false;
  {
    const ParserErrors errors;
    is_read = model.initString(arm.urdf);
    error = errors.first();
  }
  if (!is_read || !error.empty() || !kdl_parser::treeFromUrdfModel(model, tree))
  {
    throw ParameterError(arm.origin + ": its URDF cannot be read" + (error.empty() ? "" : ": " + error));
  }
}

/// Requires that each joint moves a mass, on its own link or on a link that is fixed to it. Otherwise the loads and
/// limits of all joints nearer to the base would be wrong. @throws ParameterError.
void requireMasses(const ArmDescription& arm, const KDL::Chain& chain)
{
  const KDL::Segment* moved = nullptr;
  double mass = 0.0;
  const auto require_mass = [&]
  {
    if (moved != nullptr && mass == 0.0)
    {
      throw ParameterError(arm.origin + ": in its URDF link '" + moved->getName() + "', which joint '" +
                           moved->getJoint().getName() +
                           "' moves, has no mass: it needs <inertial> with <mass value=\"KILOGRAMS\"/> above 0");
    }
  };
  for (const KDL::Segment& segment : chain.segments)
  {
    if (segment.getJoint().getType() != KDL::Joint::None)
    {
      require_mass();
      moved = &segment;
      mass = 0.0;
    }
    mass += segment.getInertia().getMass();
  }
  require_mass();
}

/// Range of the joint's angle in the URDF, or many turns if the URDF has no limits.
Range angleRange(const urdf::Model& model, const std::string& joint)
{
  const auto found = model.getJoint(joint);
  const bool is_limited =
      found->type == urdf::Joint::REVOLUTE && found->limits && found->limits->lower < found->limits->upper;
  return is_limited ? Range{ found->limits->lower, found->limits->upper } : ArmJoint{}.angles;
}

/// @throws ParameterError if no robot can have a link of this mass, inertia or size.
void requirePlausible(const ArmDescription& arm, const KDL::Segment& segment)
{
  const KDL::Joint& joint = segment.getJoint();
  const auto require = [&](bool good, const std::string& what)
  {
    if (!good)
    {
      throw ParameterError(arm.origin + ": in its URDF joint '" + joint.getName() + "' with link '" +
                           segment.getName() + "': " + what);
    }
  };
  // The comparisons are false for NaN, so the function refuses NaN.
  const auto require_range = [&](const char* what, double value, const char* unit, const Range& range)
  {
    require(value >= range.min && value <= range.max, std::string(what) + " = " + numberText(value) + " [" + unit +
                                                          "] is out of range, allowed: " + rangeText(range) + " [" +
                                                          unit + "]");
  };
  const KDL::Vector axis = joint.JointAxis();
  require(joint.getType() == KDL::Joint::None || std::abs(KDL::dot(axis, axis) - 1.0) < 1e-6,
          "its axis has no direction");
  KDL::RigidBodyInertia body = segment.getInertia();  // a copy, because RefPoint() is not const
  const KDL::RotationalInertia inertia = body.RefPoint(body.getCOG()).getRotationalInertia();
  require_range("mass", body.getMass(), "kg", Range{ 0.0, 1e4 });
  for (int i = 0; i < 3; ++i)
  {
    require_range("origin", segment.pose(0.0).p(i), "m", Range{ -100.0, 100.0 });
    require_range("centre of mass", body.getCOG()(i), "m", Range{ -100.0, 100.0 });
    for (int k = 0; k < 3; ++k)
    {
      // Rounding can make a zero moment of inertia slightly negative.
      require_range("inertia", inertia.data[3 * i + k], "kg.m^2", Range{ i == k ? -1e-9 : -1e6, 1e6 });
    }
  }
}

/// Checks the links of the arm, sets the ranges of the joints' angles, and returns the chain of the links.
KDL::Chain chainOf(ArmDescription& arm)
{
  constexpr std::size_t MAX_DEPTH = 100;
  if (depthOf(arm.urdf) > MAX_DEPTH)
  {
    throw ParameterError(arm.origin + ": its URDF has more than " + std::to_string(MAX_DEPTH) +
                         " levels of nested elements");
  }
  urdf::Model model;
  KDL::Tree tree;
  parse(arm, model, tree);
  KDL::Chain chain;
  if (!tree.getChain(arm.base, arm.tip, chain))
  {
    throw ParameterError(arm.origin + ": its URDF has no chain of links from '" + arm.base + "' to '" + arm.tip + "'");
  }
  std::size_t found = 0;
  for (const KDL::Segment& segment : chain.segments)
  {
    requirePlausible(arm, segment);
    const KDL::Joint& joint = segment.getJoint();
    if (joint.getType() == KDL::Joint::None)
    {
      continue;
    }
    if (found >= arm.joints.size() || joint.getName() != arm.joints[found].name)
    {
      throw ParameterError(arm.origin + ": joint " + std::to_string(found) + " of the URDF's chain is '" +
                           joint.getName() + "', not '" +
                           (found < arm.joints.size() ? arm.joints[found].name : std::string("none")) + "'");
    }
    arm.joints[found++].angles = angleRange(model, joint.getName());
  }
  if (found < arm.joints.size())
  {
    throw ParameterError(arm.origin + ": the URDF's chain has no joint '" + arm.joints[found].name + "'");
  }
  requireMasses(arm, chain);
  return chain;
}

std::array<double, 3> arrayOf(const KDL::Vector& vector)
{
  return { vector.x(), vector.y(), vector.z() };
}

ArmLink linkOf(const KDL::Segment& segment)
{
  const KDL::Joint& joint = segment.getJoint();
  const KDL::Frame frame = segment.getFrameToTip();
  KDL::RigidBodyInertia body = segment.getInertia();  // a copy, because RefPoint() is not const
  const KDL::RotationalInertia inertia = body.RefPoint(body.getCOG()).getRotationalInertia();
  ArmLink link;
  switch (joint.getType())
  {
    case KDL::Joint::None:
      link.motion = LinkMotion::FIXED;
      break;
    case KDL::Joint::TransAxis:
    case KDL::Joint::TransX:
    case KDL::Joint::TransY:
    case KDL::Joint::TransZ:
      link.motion = LinkMotion::SLIDES;
      break;
    default:
      link.motion = LinkMotion::TURNS;
  }
  if (link.motion != LinkMotion::FIXED)
  {
    link.axis = arrayOf(joint.JointAxis());
    link.origin = arrayOf(joint.JointOrigin());
  }
  link.position = arrayOf(frame.p);
  std::copy(std::begin(frame.M.data), std::end(frame.M.data), link.rotation.begin());
  link.mass = body.getMass();
  link.centre = arrayOf(body.getCOG());
  link.inertia = {
    inertia.data[0], inertia.data[4], inertia.data[8], inertia.data[1], inertia.data[2], inertia.data[5]
  };
  return link;
}
}  // namespace

std::string payloadErrors(const Payload& payload)
{
  // The comparisons are false for NaN, so a payload with NaN is out of range.
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
  fields("gravity", "m/s^2", arm.gravity, Range{ -100.0, 100.0 }, "acceleration of gravity in the frame of the base");
  fields("payload.mass", "kg", arm.payload.mass, PAYLOAD_MASS, "mass of the payload at the tip");
  fields("payload.centre", "m", arm.payload.centre, PAYLOAD_CENTRE,
         "centre of mass of the payload in the frame of the tip");
  if (holds(map, "state_rate"))
  {
    fields("state_rate", "Hz", arm.state_rate, Range{ 1.0, 1000.0 },
           "rate at which the controller publishes its states");
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

void readLinks(ArmDescription& arm)
{
  arm.links.clear();
  for (const KDL::Segment& segment : chainOf(arm).segments)
  {
    arm.links.push_back(linkOf(segment));
  }
}
}  // namespace hjt
