// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "tracking/reason.hpp"

namespace hjt
{
/// Standard deviation of the logarithm of a joint's friction from day to day, if no other joints show the change of the
/// friction [-]. Temperature and other causes that all joints of an arm share make this change.
constexpr double UNWITNESSED = 0.06;
/// Standard deviation of the logarithm of the common factor that three joints of one type have by chance [-]. A joint
/// whose factor has this standard deviation or more has no witnesses.
constexpr double NO_WITNESS = 0.05;

constexpr std::size_t MIN_WITNESSES = 3;  ///< least number of joints that can confirm a common factor

/// Number of joints from base to elbow in an arm of `joints` joints. The other joints are the wrists.
inline std::size_t jointsToElbow(std::size_t joints)
{
  return (joints + 1) / 2;
}

/// Friction of one joint of an arm.
struct MeasuredFriction
{
  std::optional<double> ratio;       ///< measured over expected friction; none: not known [-]
  double temperature{};              ///< temperature at which the expected friction holds [degC]
  bool temperature_received{};       ///< whether `temperature` was received
  std::function<double(double)> at;  ///< mean friction of the twin in the measured motion [N.m] at a temperature [degC]
  bool is_below_faults{};            ///< whether the joint has less friction than any fault leaves
  bool is_none{};                    ///< whether the joint has nearly no friction
  bool is_against{};                 ///< whether measured and predicted current have opposite signs
  bool is_load_wrong{};              ///< whether the measured current fits no load of this joint
  bool is_to_own{};                  ///< whether the expected friction is this joint's own when it was sound
};

/// A group of joints that are assumed to be built and warmed alike: the joints from base to elbow, or the wrists.
struct JointGroup
{
  std::size_t begin{};
  std::size_t end{};     ///< number of the first joint after the group
  double median{ 1.0 };  ///< median of the joints' friction ratios over the factor of the whole arm [-]
  bool is_known{};       ///< whether the ratios of at least three joints are known and most agree on the median
};

/// Common factors of the friction of an arm's joints.
struct ArmFriction
{
  std::vector<double> factors;     ///< factor of each joint: factor of the arm times factor of the group [-]
  std::vector<double> deviations;  ///< standard deviation of each factor's logarithm; 0: other joints are witnesses [-]
  double median{ 1.0 };            ///< factor of the whole arm; 1: the joints have no factor in common [-]
  std::optional<double> temperature;  ///< temperature that explains `median`; none: received, or not 0 to 60 [degC]
  std::vector<JointGroup> groups;
  bool is_known{};  ///< whether at least MIN_WITNESSES joints show their friction
  Misfit misfit;    ///< why no joint of the arm is judged; empty: the joints are judged
};

/// Finds the common factors of the friction of an arm's joints. The factor of the whole arm is the median of the
/// joints' friction ratios, if most of at least three joints agree on the median within `tolerance`, and if the median
/// differs from 1 by more than `tolerance`. So one faulty joint changes neither the factor nor the temperature.
///
/// A group has a further factor if most of its three joints agree on the ratio that remains after division by the
/// factor of the arm, because three drives do not fail alike. If a joint of the group is compared with its type, 5 % of
/// the group's factor may be chance. These 5 % are then the deviation of the factor for the joints that are compared
/// with themselves. If a group has more friction than expected, the group's factor never makes the friction of a joint
/// look too low. If a group has less friction than expected, the factor can make that of a joint look too high; the
/// scatter of the group's other joints beyond the scatter of sound joints adds to the deviation.
///
/// No joint is judged in three cases. If two or more joints have less friction than any fault leaves, something outside
/// carries the arm. If the currents of two or more joints fit no load, or those of one joint while a second joint has
/// less friction than any fault leaves, the arm's load is not the configured one. If one joint has less friction than
/// any fault leaves and a second joint has more than twice the expected friction, the joints are not in the configured
/// order.
ArmFriction commonFriction(const std::vector<MeasuredFriction>& joints, double tolerance);

/// Why a joint is not judged. `joint`: misfit of the joint itself, `arm`: misfit of all joints, which counts if `joint`
/// is empty. Wrong signs of the arm's efforts replace a wrong load as the reason, because they explain it.
inline const Misfit& misfitOf(const Misfit& joint, const Misfit& arm)
{
  const bool is_sign = joint.reason == Reason::LOAD_WRONG && arm.reason == Reason::EFFORT_NOT_CURRENT;
  return !joint.exists() || (arm.exists() && is_sign) ? arm : joint;
}
}  // namespace hjt
