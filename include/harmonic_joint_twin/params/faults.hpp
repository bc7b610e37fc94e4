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

/// Kinds of faults: those of the thesis' FMECA (Table 3.7), and four faults of the wave generator's bearing.
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
  COUNT  ///< number of kinds of faults
};
constexpr std::size_t FAULT_KINDS = static_cast<std::size_t>(FaultKind::COUNT);  ///< number of kinds of faults

/// Value of Fault::place for a fault of the whole part, not of one of its teeth, segments, lobes or balls.
constexpr int WHOLE_MEMBER = -1;

/// Largest number of faults that can be active or configured at once.
constexpr std::size_t MAX_FAULTS = 256;

/// Fault of the gear. A second fault of equal kind and place replaces the severity of the first fault.
struct Fault
{
  FaultKind kind{};
  double severity{};          ///< size of the fault from 0 (no fault) to 1, see FaultDescription::severity [-]
  int place{ WHOLE_MEMBER };  ///< number of the tooth, segment, lobe or ball, from 0; WHOLE_MEMBER: the whole part
  double onset{};             ///< delay from the start, or from the stamp of the injection, to the fault; >= 0 [s]

  /// Whether a configured fault is active from the start.
  bool isActiveAtStart() const noexcept { return severity > 0.0 && onset == 0.0; }
};

/// Parts that Fault::place counts.
enum class FaultPlace : std::uint8_t
{
  MEMBER,      ///< no places: the fault always concerns the whole part
  TOOTH,       ///< teeth of the flexspline
  SEGMENT,     ///< segments of the rim, each from one tooth to the next
  LOBE,        ///< lobes of the wave generator: 0 at the wave generator's angle, 1 half a turn away
  INNER_RACE,  ///< tooth pitches along the inner race, counted from lobe 0
  OUTER_RACE,  ///< tooth pitches along the outer race, counted from tooth 0
  BALL         ///< balls of the bearing, or pockets of its cage
};

/// Description of a kind of fault: a row of FAULT_DESCRIPTIONS.
struct FaultDescription
{
  FaultKind kind;
  const char* name;      ///< name of the kind in files and messages
  FaultPlace place;      ///< parts that Fault::place counts
  bool whole;            ///< whether the kind allows WHOLE_MEMBER
  const char* severity;  ///< size of the fault at severity 1
  const char* shows;     ///< signal that shows the fault first; shownFirst replaces each name in braces by an order
};

/// Descriptions of all kinds, in the order of FaultKind.
inline constexpr std::array FAULT_DESCRIPTIONS{
  FaultDescription{
      FaultKind::INTERFACE_WEAR, "interface_wear", FaultPlace::SEGMENT, true,
      "rim and outer race worn by fault_scale.interface_wear_depth, friction multiplied by interface_friction_factor",
      "stiffness and lost motion about zero torque" },
  FaultDescription{ FaultKind::REAR_SECTION_CRACK, "rear_section_crack", FaultPlace::MEMBER, true,
                    "crack behind the teeth over fault_scale.cup_crack_fraction of the circumference",
                    "hysteresis, torsional stiffness" },
  FaultDescription{ FaultKind::LUBRICANT_DEGRADATION, "lubricant_degradation", FaultPlace::MEMBER, true,
                    "viscosity and boundary friction multiplied by their factors of fault_scale", "running torque" },
  FaultDescription{ FaultKind::TOOTH_WEAR, "tooth_wear", FaultPlace::TOOTH, true,
                    "both flanks worn by fault_scale.tooth_wear_depth along their normal", "lost motion" },
  FaultDescription{
      FaultKind::TOOTH_ROOT_CRACK, "tooth_root_crack", FaultPlace::TOOTH, false,
      "tooth broken off, or crack of fault_scale.rim_crack_depth in the rim, depending on the backup ratio",
      "orders 2, 4, 6 ... of the kinematic error" },
  FaultDescription{ FaultKind::FLANGE_CRACK, "flange_crack", FaultPlace::MEMBER, true,
                    "crack at the cup's flange over fault_scale.cup_crack_fraction of the circumference",
                    "torsional stiffness, hysteresis" },
  FaultDescription{ FaultKind::TOOTH_TIP_CRACK, "tooth_tip_crack", FaultPlace::TOOTH, false,
                    "crack along the middle of the tooth, which divides the whole height of the tooth into halves",
                    "orders 2, 4, 6 ... of the kinematic error" },
  FaultDescription{
      FaultKind::PITTING, "pitting", FaultPlace::TOOTH, true,
      "flanks narrower by the share fault_scale.pitted_fraction, friction multiplied by pitted_friction_factor",
      "with one pitted tooth: orders 2, 4, 6 ... of the kinematic error" },
  FaultDescription{ FaultKind::WAVE_GENERATOR_WEAR, "wave_generator_wear", FaultPlace::LOBE, true,
                    "major semi-axis of the wave generator smaller by fault_scale.wave_generator_wear_depth",
                    "lost motion, stiffness, lower running torque" },
  FaultDescription{
      FaultKind::FLEXSPLINE_CRACK, "flexspline_crack", FaultPlace::SEGMENT, false,
      "crack of fault_scale.rim_crack_depth in the rim, whose depth falls to zero over rim_crack_segments",
      "orders 2, 4, 6 ... of the kinematic error" },
  FaultDescription{
      FaultKind::BUCKLING, "buckling", FaultPlace::MEMBER, true,
      "cup softer by fault_scale.buckling_stiffness_loss, rim out of round by fault_scale.buckling_out_of_round",
      "torsional stiffness, hysteresis" },
  FaultDescription{
      FaultKind::RATCHETING, "ratcheting", FaultPlace::MEMBER, true,
      "circular spline off centre by fault_scale.ratcheting_eccentricity, teeth shorter by ratcheting_tip_loss",
      "running torque, orders 2 and {spline}" },
  FaultDescription{ FaultKind::BEARING_INNER_RACE, "bearing_inner_race", FaultPlace::INNER_RACE, false,
                    "spall of fault_scale.spall_depth and spall_length on the inner race", "order {inner}" },
  FaultDescription{ FaultKind::BEARING_OUTER_RACE, "bearing_outer_race", FaultPlace::OUTER_RACE, false,
                    "spall of fault_scale.spall_depth and spall_length on the outer race",
                    "order {outer} with sidebands at a distance of 2" },
  FaultDescription{ FaultKind::BEARING_BALL, "bearing_ball", FaultPlace::BALL, false,
                    "spall of fault_scale.spall_depth and spall_length on a ball", "orders {ball} and {lobe}" },
  FaultDescription{ FaultKind::BEARING_CAGE, "bearing_cage", FaultPlace::BALL, false,
                    "outer race lower by fault_scale.cage_deflection at the ball whose pocket in the cage is broken",
                    "order {lobe}: twice the difference of 1 and the cage's order {cage}" }
};

/// Whether a table has one row for each kind of fault, in the order of FaultKind.
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

/// Row of FAULT_DESCRIPTIONS; `kind` must not be COUNT.
constexpr const FaultDescription& describe(FaultKind kind) noexcept
{
  return FAULT_DESCRIPTIONS[static_cast<std::size_t>(kind)];
}

/// Signal that shows a fault of this kind first, with the orders in the drive with these parameters.
std::string shownFirst(FaultKind kind, const Parameters& parameters);
std::optional<FaultKind> faultNamed(const std::string& name);  ///< kind with this name; nothing if there is none
std::string faultNames();                                      ///< names of all kinds, for an error message

/// Word for a place, for example "tooth" or "segment of the rim"; "-" for MEMBER.
const char* placeName(FaultPlace place) noexcept;
/// Number of parts in the gear that `place` counts; 0 for MEMBER.
int placesOf(FaultPlace place, const Parameters& parameters) noexcept;
int firstPlace(FaultKind kind) noexcept;  ///< least place that the kind of fault allows: WHOLE_MEMBER or 0
/// Largest place that the kind of fault allows in the gear.
int lastPlace(FaultKind kind, const Parameters& parameters) noexcept;

/// Text of the places that a kind of fault allows, for example "tooth 0 ... 199 or -1 (the whole part)".
std::string placeText(FaultKind kind, const Parameters& parameters);

/// Whether severity, place and onset of the fault are within their ranges.
bool isValid(const Fault& fault, const Parameters& parameters) noexcept;
/// Error messages for the fault, one per line, each after `key`; empty if the fault is valid.
std::string faultErrors(const Fault& fault, const Parameters& parameters, const std::string& key);

/// Parses KIND:SEVERITY[:PLACE[:ONSET]]. The default of PLACE is the least allowed place. @throws ParameterError.
Fault parseFault(const std::string& text, const Parameters& parameters);
}  // namespace hjt
