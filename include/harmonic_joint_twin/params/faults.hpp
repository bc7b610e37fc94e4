// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace hjt
{
struct Parameters;

/// The rows of the thesis' FMECA (Table 3.7), and the wave generator's bearing.
enum class FaultKind : std::uint8_t
{
  INTERFACE_WEAR,
  REAR_SECTION_CRACK,
  LUBRICANT_DEGRADATION,
  TOOTH_WEAR,
  TOOTH_ROOT_CRACK,
  FLANGE_CRACK,
  TOOTH_TIP_CRACK,
  PITTING,
  WAVE_GENERATOR_WEAR,
  FLEXSPLINE_CRACK,
  BUCKLING,
  RATCHETING,
  BEARING_INNER_RACE,
  BEARING_OUTER_RACE,
  BEARING_BALL,
  BEARING_CAGE
};
constexpr std::size_t FAULT_KINDS = 16;

/// Where no place is meant: the whole member.
constexpr int WHOLE_MEMBER = -1;

/// As many can be active at once, and be configured.
constexpr std::size_t MOST_FAULTS = 256;

/// One fault of the gear. It is known by kind and place: the same once more replaces its severity.
struct Fault
{
  FaultKind kind{};
  double severity{};  ///< 0 none ... 1, see FaultDescription::severity [-]
  int place{
    WHOLE_MEMBER
  };               ///< tooth, segment, lobe or ball by kind, from 0 on; WHOLE_MEMBER where the kind allows it
  double onset{};  ///< after the start, or after the stamp that it was injected with; >= 0 [s]

  /// Of a configured one: the twin starts with it.
  bool isThereFromTheStart() const noexcept { return severity > 0.0 && onset == 0.0; }
};

/// What a place counts.
enum class FaultPlace : std::uint8_t
{
  MEMBER,      ///< the whole member only
  TOOTH,       ///< teeth of the flexspline
  SEGMENT,     ///< of the rim, from a tooth to the next
  LOBE,        ///< of the wave generator: 0 at its angle, 1 opposite
  INNER_RACE,  ///< tooth pitches along the inner race from lobe 0
  OUTER_RACE,  ///< tooth pitches along the outer race from tooth 0
  BALL         ///< balls, or pockets of the cage
};

struct FaultDescription
{
  FaultKind kind;
  const char* name;
  FaultPlace place;
  bool whole;            ///< WHOLE_MEMBER is allowed
  const char* severity;  ///< what severity 1 is
  const char* shows;     ///< where it shows first
};

const std::array<FaultDescription, FAULT_KINDS>& faultDescriptions() noexcept;
const FaultDescription& describe(FaultKind kind) noexcept;
std::optional<FaultKind> faultNamed(const std::string& name);
std::string faultNames();  ///< all, for an error text

/// How a place of this kind is spelt, for a table.
const char* placeName(FaultPlace place) noexcept;
/// Places that there are in this gear.
int placesOf(FaultPlace place, const Parameters& parameters) noexcept;
int firstPlace(FaultKind kind) noexcept;  ///< the least allowed: WHOLE_MEMBER or 0
int lastPlace(FaultKind kind, const Parameters& parameters) noexcept;

/// The places of a kind: "tooth 0 ... 199 or -1 (the whole member)".
std::string placeText(FaultKind kind, const Parameters& parameters);

/// Whether severity, place and onset are within their ranges.
bool isValid(const Fault& fault, const Parameters& parameters) noexcept;
/// What is wrong with it, with values and ranges, one a line; empty if nothing is. `key` leads each line.
std::string faultErrors(const Fault& fault, const Parameters& parameters, const std::string& key);

/// Reads KIND:SEVERITY[:PLACE[:ONSET]]; without a place it is the first allowed. @throws ParameterError.
Fault parseFault(const std::string& text, const Parameters& parameters);
}  // namespace hjt
