// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/params/faults.hpp"
#include "base/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "params/severity_errors.hpp"

namespace hjt
{
namespace
{
constexpr double LATEST_ONSET = 1e9;  // largest allowed onset of a fault [s]

/// Orders of moving parts of the drive, each with the name in braces that stands for it in FaultDescription::shows.
std::array<std::pair<const char*, double>, 6> orders(const Parameters& parameters)
{
  const double balls = parameters.bearing.balls;
  const double ratio = parameters.bearing.ball_diameter / parameters.bearing.pitch_diameter;
  const double cage = 0.5 * (1.0 - ratio);
  const GearParameters& gear = parameters.gear;
  return { { { "{inner}", balls * (1.0 - cage) },
             { "{outer}", balls * cage },
             { "{ball}", 1.0 / ratio - ratio },
             { "{cage}", cage },
             { "{lobe}", 2.0 * (1.0 - cage) },
             { "{spline}", 2.0 * gear.teeth_flexspline / gear.teeth_circular_spline } } };
}

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

std::optional<FaultKind> faultNamed(const std::string& name)
{
  const auto found = std::find_if(FAULT_DESCRIPTIONS.begin(), FAULT_DESCRIPTIONS.end(),
                                  [&](const FaultDescription& description) { return name == description.name; });
  return found == FAULT_DESCRIPTIONS.end() ? std::nullopt : std::optional<FaultKind>(found->kind);
}

std::string faultNames()
{
  return joined(FAULT_DESCRIPTIONS, ", ", [](const FaultDescription& description) { return description.name; });
}

const char* placeName(FaultPlace place) noexcept
{
  constexpr std::array NAMES{
    "-", "tooth", "segment of the rim", "lobe", "tooth pitch from lobe 0", "tooth pitch from tooth 0", "ball"
  };
  return NAMES[static_cast<std::size_t>(place)];
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

std::string shownFirst(FaultKind kind, const Parameters& parameters)
{
  std::string text = describe(kind).shows;
  for (const auto& [name, order] : orders(parameters))
  {
    const std::size_t at = text.find(name);
    if (at != std::string::npos)
    {
      text.replace(at, std::strlen(name), fixedText(order, 2));
    }
  }
  return text;
}

std::string placeText(FaultKind kind, const Parameters& parameters)
{
  const int last = lastPlace(kind, parameters);
  const std::string whole = "-1 (the whole part)";
  if (last < 0)
  {
    return whole;
  }
  const std::string numbers = std::string(placeName(describe(kind).place)) + " 0 ... " + std::to_string(last);
  return describe(kind).whole ? numbers + " or " + whole : numbers;
}

bool isValid(const Fault& fault, const Parameters& parameters) noexcept
{
  // If the severity or the onset is NaN, its comparisons are false.
  return static_cast<std::size_t>(fault.kind) < FAULT_KINDS && fault.severity >= 0.0 && fault.severity <= 1.0 &&
         fault.place >= firstPlace(fault.kind) && fault.place <= lastPlace(fault.kind, parameters) &&
         fault.onset >= 0.0 && fault.onset <= LATEST_ONSET;
}

std::string faultErrors(const Fault& fault, const Parameters& parameters, const std::string& key)
{
  std::string text = severityErrors(fault, key);
  const auto refuse = [&](bool good, const std::string& what)
  { text += good ? "" : (text.empty() ? "" : "\n") + key + what; };
  const std::string of = std::string(" of ") + describe(fault.kind).name;
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
  const std::string origin = "fault " + text + ": ";
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
