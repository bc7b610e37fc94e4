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
  BEARING_CAGE,
  COUNT  ///< number of kinds
};
constexpr std::size_t FAULT_KINDS = static_cast<std::size_t>(FaultKind::COUNT);  ///< number of kinds

/// Value of Fault::place for a fault of the whole member.
constexpr int WHOLE_MEMBER = -1;

/// Most faults that can be active at once, and be configured.
constexpr std::size_t MAX_FAULTS = 256;

/// One fault of the gear. It is known by kind and place: the same once more replaces its severity.
struct Fault
{
  FaultKind kind{};
  double severity{};  ///< 0 none ... 1, see FaultDescription::severity [-]
  int place{
    WHOLE_MEMBER
  };               ///< tooth, segment, lobe or ball by kind, from 0 on; WHOLE_MEMBER where the kind allows it
  double onset{};  ///< after the start, or after the stamp that it was injected with; >= 0 [s]

  /// Whether a twin with this fault in its configuration starts with it.
  bool isActiveAtStart() const noexcept { return severity > 0.0 && onset == 0.0; }
};

/// Parts that Fault::place numbers.
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

/// Description of a kind of fault: a row of FAULT_DESCRIPTIONS.
struct FaultDescription
{
  FaultKind kind;
  const char* name;      ///< of the kind, in files and messages
  FaultPlace place;      ///< parts that Fault::place numbers
  bool whole;            ///< WHOLE_MEMBER is allowed
  const char* severity;  ///< size of the fault at severity 1
  const char* shows;     ///< where it shows first; orders by a name in braces, see shownFirst
};

/// All kinds, in the order of FaultKind.
inline constexpr std::array FAULT_DESCRIPTIONS{
  FaultDescription{ FaultKind::INTERFACE_WEAR, "interface_wear", FaultPlace::SEGMENT, true,
                    "rim and outer race worn by fault_scale.interface_wear_depth, rougher by its friction factor",
                    "stiffness and lost motion about zero torque" },
  FaultDescription{ FaultKind::REAR_SECTION_CRACK, "rear_section_crack", FaultPlace::MEMBER, true,
                    "crack behind the teeth over fault_scale.cup_crack_fraction of the circumference",
                    "torsion loop, torsional stiffness" },
  FaultDescription{ FaultKind::LUBRICANT_DEGRADATION, "lubricant_degradation", FaultPlace::MEMBER, true,
                    "viscosity and boundary friction times the factors of fault_scale", "running torque" },
  FaultDescription{ FaultKind::TOOTH_WEAR, "tooth_wear", FaultPlace::TOOTH, true,
                    "fault_scale.tooth_wear_depth off both flanks, along their normal", "lost motion" },
  FaultDescription{
      FaultKind::TOOTH_ROOT_CRACK, "tooth_root_crack", FaultPlace::TOOTH, false,
      "crack through the tooth (broken off), or fault_scale.rim_crack_depth into the rim, by the backup ratio",
      "orders 2, 4, 6 ... of the kinematic error" },
  FaultDescription{ FaultKind::FLANGE_CRACK, "flange_crack", FaultPlace::MEMBER, true,
                    "crack at the cup's flange over fault_scale.cup_crack_fraction of the circumference",
                    "torsional stiffness, torsion loop" },
  FaultDescription{ FaultKind::TOOTH_TIP_CRACK, "tooth_tip_crack", FaultPlace::TOOTH, false,
                    "crack along the tooth's middle as long as the tooth is high: two leaves",
                    "orders 2, 4, 6 ... of the kinematic error" },
  FaultDescription{
      FaultKind::PITTING, "pitting", FaultPlace::TOOTH, true,
      "fault_scale.pitted_fraction of the flank's width lost, its friction times fault_scale.pitted_friction_factor",
      "one tooth: orders 2, 4, 6 ... of the kinematic error" },
  FaultDescription{ FaultKind::WAVE_GENERATOR_WEAR, "wave_generator_wear", FaultPlace::LOBE, true,
                    "major semi-axis less by fault_scale.wave_generator_wear_depth",
                    "lost motion, stiffness, lower running torque" },
  FaultDescription{
      FaultKind::FLEXSPLINE_CRACK, "flexspline_crack", FaultPlace::SEGMENT, false,
      "rim cracked by fault_scale.rim_crack_depth here, fading out over fault_scale.rim_crack_segments either side",
      "orders 2, 4, 6 ... of the kinematic error" },
  FaultDescription{
      FaultKind::BUCKLING, "buckling", FaultPlace::MEMBER, true,
      "cup softer by fault_scale.buckling_stiffness_loss, rim bent to waves of fault_scale.buckling_out_of_round",
      "torsional stiffness, torsion loop" },
  FaultDescription{ FaultKind::RATCHETING, "ratcheting", FaultPlace::MEMBER, true,
                    "circular spline off centre by fault_scale.ratcheting_eccentricity, tips shorter by its tip loss",
                    "running torque, orders 2 and {spline}" },
  FaultDescription{ FaultKind::BEARING_INNER_RACE, "bearing_inner_race", FaultPlace::INNER_RACE, false,
                    "spall of fault_scale.spall_depth and spall_length on the inner race", "order {inner}" },
  FaultDescription{ FaultKind::BEARING_OUTER_RACE, "bearing_outer_race", FaultPlace::OUTER_RACE, false,
                    "spall of fault_scale.spall_depth and spall_length on the outer race",
                    "order {outer} and its sidebands at 2" },
  FaultDescription{ FaultKind::BEARING_BALL, "bearing_ball", FaultPlace::BALL, false,
                    "spall of fault_scale.spall_depth and spall_length on a ball", "orders {ball} and {lobe}" },
  FaultDescription{ FaultKind::BEARING_CAGE, "bearing_cage", FaultPlace::BALL, false,
                    "the ball of a broken pocket lets the outer race down by fault_scale.cage_deflection",
                    "order {lobe}: twice 1 less the cage's {cage}" }
};

/// Whether the rows of a table with one for each kind of fault stand in the order of FaultKind.
template <class Table>
constexpr bool hasRowsInOrder(const Table& table) noexcept
{
  bool in_order = table.size() == FAULT_KINDS;
  for (std::size_t i = 0; i < table.size(); ++i)
  {
    in_order = in_order && static_cast<std::size_t>(table[i].kind) == i;
  }
  return in_order;
}
static_assert(hasRowsInOrder(FAULT_DESCRIPTIONS), "one row for each FaultKind, in its order");

constexpr const FaultDescription& describe(FaultKind kind) noexcept  ///< row of the table; `kind` is not COUNT
{
  return FAULT_DESCRIPTIONS[static_cast<std::size_t>(kind)];
}
/// Signal in which it shows first in this drive, with the orders of its own bearing and teeth.
std::string shownFirst(FaultKind kind, const Parameters& parameters);
std::optional<FaultKind> faultNamed(const std::string& name);  ///< nothing if no kind has this name
std::string faultNames();                                      ///< all, for an error text

/// Word for a place of this kind, for a table: tooth, segment, lobe, ball or -.
const char* placeName(FaultPlace place) noexcept;
/// Number of such places in this gear.
int placesOf(FaultPlace place, const Parameters& parameters) noexcept;
int firstPlace(FaultKind kind) noexcept;                               ///< the least allowed: WHOLE_MEMBER or 0
int lastPlace(FaultKind kind, const Parameters& parameters) noexcept;  ///< the greatest allowed in this gear

/// The places of a kind: "tooth 0 ... 199 or -1 (the whole member)".
std::string placeText(FaultKind kind, const Parameters& parameters);

/// Whether severity, place and onset are within their ranges.
bool isValid(const Fault& fault, const Parameters& parameters) noexcept;
/// Errors of the fault, with values and ranges, one a line; empty if it is valid. `key` begins each line.
std::string faultErrors(const Fault& fault, const Parameters& parameters, const std::string& key);

/// Reads KIND:SEVERITY[:PLACE[:ONSET]]; without a place it is the first allowed. @throws ParameterError.
Fault parseFault(const std::string& text, const Parameters& parameters);
}  // namespace hjt
