// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/params/faults.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
namespace
{
constexpr double LATEST_ONSET = 1e9;  // s

constexpr std::array<FaultDescription, FAULT_KINDS> DESCRIPTIONS{ {
    { FaultKind::INTERFACE_WEAR, "interface_wear", FaultPlace::SEGMENT, true,
      "rim and outer race worn by fault_scale.interface_wear_depth, rougher by its friction factor",
      "stiffness and lost motion about zero torque" },
    { FaultKind::REAR_SECTION_CRACK, "rear_section_crack", FaultPlace::MEMBER, true,
      "crack behind the teeth over fault_scale.cup_crack_fraction of the circumference",
      "torsion loop, torsional stiffness" },
    { FaultKind::LUBRICANT_DEGRADATION, "lubricant_degradation", FaultPlace::MEMBER, true,
      "viscosity and boundary friction times the factors of fault_scale", "running torque" },
    { FaultKind::TOOTH_WEAR, "tooth_wear", FaultPlace::TOOTH, true,
      "fault_scale.tooth_wear_depth off both flanks, along their normal", "lost motion" },
    { FaultKind::TOOTH_ROOT_CRACK, "tooth_root_crack", FaultPlace::TOOTH, false,
      "crack through the tooth (broken off), or fault_scale.rim_crack_depth into the rim, by the backup ratio",
      "orders 2, 4, 6 ... of the kinematic error" },
    { FaultKind::FLANGE_CRACK, "flange_crack", FaultPlace::MEMBER, true,
      "crack at the cup's flange over fault_scale.cup_crack_fraction of the circumference",
      "torsional stiffness, torsion loop" },
    { FaultKind::TOOTH_TIP_CRACK, "tooth_tip_crack", FaultPlace::TOOTH, false,
      "crack along the tooth's middle as long as the tooth is high: two leaves",
      "orders 2, 4, 6 ... of the kinematic error" },
    { FaultKind::PITTING, "pitting", FaultPlace::TOOTH, true,
      "fault_scale.pitted_fraction of the flank's width lost, its friction times fault_scale.pitted_friction_factor",
      "one tooth: orders 2, 4, 6 ... of the kinematic error" },
    { FaultKind::WAVE_GENERATOR_WEAR, "wave_generator_wear", FaultPlace::LOBE, true,
      "major semi-axis less by fault_scale.wave_generator_wear_depth", "lost motion, stiffness, lower running torque" },
    { FaultKind::FLEXSPLINE_CRACK, "flexspline_crack", FaultPlace::SEGMENT, false,
      "rim cracked by fault_scale.rim_crack_depth here, fading out over fault_scale.rim_crack_segments either side",
      "orders 2, 4, 6 ... of the kinematic error" },
    { FaultKind::BUCKLING, "buckling", FaultPlace::MEMBER, true,
      "cup softer by fault_scale.buckling_stiffness_loss, rim bent to waves of fault_scale.buckling_out_of_round",
      "torsional stiffness, torsion loop" },
    { FaultKind::RATCHETING, "ratcheting", FaultPlace::MEMBER, true,
      "circular spline off centre by fault_scale.ratcheting_eccentricity, tips shorter by its tip loss",
      "running torque, orders 2 and 1.98" },
    { FaultKind::BEARING_INNER_RACE, "bearing_inner_race", FaultPlace::INNER_RACE, false,
      "spall of fault_scale.spall_depth and spall_length on the inner race", "order 12.68" },
    { FaultKind::BEARING_OUTER_RACE, "bearing_outer_race", FaultPlace::OUTER_RACE, false,
      "spall of fault_scale.spall_depth and spall_length on the outer race", "order 10.32 and its sidebands at 2" },
    { FaultKind::BEARING_BALL, "bearing_ball", FaultPlace::BALL, false,
      "spall of fault_scale.spall_depth and spall_length on a ball", "orders 9.65 and 1.10" },
    { FaultKind::BEARING_CAGE, "bearing_cage", FaultPlace::BALL, false,
      "the ball of a broken pocket lets the outer race down by fault_scale.cage_sag",
      "order 1.10: twice 1 less the cage's 0.45" },
} };

constexpr bool inOrder() noexcept
{
  for (std::size_t i = 0; i < FAULT_KINDS; ++i)
  {
    if (static_cast<std::size_t>(DESCRIPTIONS[i].kind) != i)
    {
      return false;
    }
  }
  return true;
}
static_assert(inOrder(), "described in the order of FaultKind");

std::vector<std::string> split(const std::string& text)
{
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t colon = text.find(':'); colon != std::string::npos; colon = text.find(':', begin))
  {
    parts.push_back(text.substr(begin, colon - begin));
    begin = colon + 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

}  // namespace

const std::array<FaultDescription, FAULT_KINDS>& faultDescriptions() noexcept
{
  return DESCRIPTIONS;
}

const FaultDescription& describe(FaultKind kind) noexcept
{
  return DESCRIPTIONS[static_cast<std::size_t>(kind)];
}

std::optional<FaultKind> faultNamed(const std::string& name)
{
  const auto found = std::find_if(DESCRIPTIONS.begin(), DESCRIPTIONS.end(),
                                  [&](const FaultDescription& description) { return name == description.name; });
  return found == DESCRIPTIONS.end() ? std::nullopt : std::optional<FaultKind>(found->kind);
}

std::string faultNames()
{
  std::string names;
  for (const FaultDescription& description : DESCRIPTIONS)
  {
    names += (names.empty() ? "" : ", ") + std::string(description.name);
  }
  return names;
}

const char* placeName(FaultPlace place) noexcept
{
  switch (place)
  {
    case FaultPlace::MEMBER:
      return "-";
    case FaultPlace::TOOTH:
      return "tooth";
    case FaultPlace::SEGMENT:
      return "segment of the rim";
    case FaultPlace::LOBE:
      return "lobe";
    case FaultPlace::INNER_RACE:
      return "tooth pitch from lobe 0";
    case FaultPlace::OUTER_RACE:
      return "tooth pitch from tooth 0";
    case FaultPlace::BALL:
      return "ball";
  }
  return "-";
}

int placesOf(FaultPlace place, const Parameters& parameters) noexcept
{
  switch (place)
  {
    case FaultPlace::MEMBER:
      return 0;
    case FaultPlace::LOBE:
      return 2;
    case FaultPlace::BALL:
      return parameters.bearing.balls;
    case FaultPlace::TOOTH:
    case FaultPlace::SEGMENT:
    case FaultPlace::INNER_RACE:
    case FaultPlace::OUTER_RACE:
      break;
  }
  return parameters.gear.teeth_flexspline;
}

int firstPlace(FaultKind kind) noexcept
{
  return describe(kind).whole ? WHOLE_MEMBER : 0;
}

int lastPlace(FaultKind kind, const Parameters& parameters) noexcept
{
  return placesOf(describe(kind).place, parameters) - 1;
}

std::string placeText(FaultKind kind, const Parameters& parameters)
{
  const int last = lastPlace(kind, parameters);
  const std::string whole = "-1 (the whole member)";
  if (last < 0)
  {
    return whole;
  }
  const std::string numbers = std::string(placeName(describe(kind).place)) + " 0 ... " + std::to_string(last);
  return describe(kind).whole ? numbers + " or " + whole : numbers;
}

bool isValid(const Fault& fault, const Parameters& parameters) noexcept
{
  // Written so that NaN fails.
  return static_cast<std::size_t>(fault.kind) < FAULT_KINDS && fault.severity >= 0.0 && fault.severity <= 1.0 &&
         fault.place >= firstPlace(fault.kind) && fault.place <= lastPlace(fault.kind, parameters) &&
         fault.onset >= 0.0 && fault.onset <= LATEST_ONSET;
}

std::string faultErrors(const Fault& fault, const Parameters& parameters, const std::string& key)
{
  std::string text;
  const auto refuse = [&](bool good, const std::string& what)
  { text += good ? "" : (text.empty() ? "" : "\n") + key + what; };
  const std::string of = std::string(" of ") + describe(fault.kind).name;
  refuse(fault.severity >= 0.0 && fault.severity <= 1.0,
         "severity = " + numberText(fault.severity) + " [-]" + of + " is out of range, allowed: 0 ... 1 [-]");
  refuse(fault.place >= firstPlace(fault.kind) && fault.place <= lastPlace(fault.kind, parameters),
         "place = " + std::to_string(fault.place) + " [-]" + of +
             " is out of range, allowed: " + placeText(fault.kind, parameters));
  refuse(fault.onset >= 0.0 && fault.onset <= LATEST_ONSET, "onset = " + numberText(fault.onset) + " [s]" + of +
                                                                " is out of range, allowed: 0 ... " +
                                                                numberText(LATEST_ONSET) + " [s]");
  return text;
}

Fault parseFault(const std::string& text, const Parameters& parameters)
{
  const std::vector<std::string> parts = split(text);
  const std::string origin = "--fault " + text + ": ";
  if (parts.size() < 2 || parts.size() > 4)
  {
    throw ParameterError(origin + "expected KIND:SEVERITY[:PLACE[:ONSET]]");
  }
  const std::optional<FaultKind> kind = faultNamed(parts[0]);
  if (!kind)
  {
    throw ParameterError(origin + "unknown kind '" + parts[0] + "', allowed: " + faultNames());
  }
  const auto number = [&](std::size_t i, const char* what)
  {
    const std::optional<double> value = decimalNumber(parts[i]);
    if (!value)
    {
      throw ParameterError(origin + what + " '" + parts[i] + "' is not a number");
    }
    return *value;
  };
  Fault fault;
  fault.kind = *kind;
  fault.severity = number(1, "severity");
  fault.place = firstPlace(*kind);
  if (parts.size() > 2)
  {
    const double place = number(2, "place");
    if (place != std::floor(place) || std::abs(place) > 1e6)
    {
      throw ParameterError(origin + "place '" + parts[2] + "' is not a whole number");
    }
    fault.place = static_cast<int>(place);
  }
  fault.onset = parts.size() > 3 ? number(3, "onset") : 0.0;
  const std::string errors = faultErrors(fault, parameters, origin);
  if (!errors.empty())
  {
    throw ParameterError(errors);
  }
  return fault;
}
}  // namespace hjt
