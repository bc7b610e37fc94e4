// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "tracking/reason.hpp"

namespace hjt
{
/// Change of a joint's friction from day to day by its temperature and by whatever else the joints of an arm share,
/// where no other joints show that change: standard deviation of the logarithm [-].
constexpr double UNWITNESSED = 0.06;
/// Deviation of a common factor from which on the joints that share it are no witnesses: standard deviation of the
/// logarithm. Three joints of one type may have as much in common by chance [-].
constexpr double NO_WITNESS = 0.05;

/// Least number of joints that can confirm a common factor.
constexpr std::size_t MIN_WITNESSES = 3;

/// Number of an arm's joints from the base to the elbow. The other joints are the wrists.
inline std::size_t jointsToElbow(std::size_t joints)
{
  return (joints + 1) / 2;
}

/// Friction of one joint of an arm.
struct MeasuredFriction
{
  std::optional<double> ratio;       ///< measured over expected friction; none: the ratio is not known
  double temperature{};              ///< temperature of the expected friction [degC]
  bool temperature_received{};       ///< the temperature was measured
  std::function<double(double)> at;  ///< friction of the twin at a temperature [degC] in the measured motion [N.m]
  bool is_below_faults{};            ///< the friction is less than any fault leaves
  bool is_none{};                    ///< the friction is nearly zero
  bool is_against{};                 ///< the current has the opposite sign of the current that the motion takes
  bool is_load_wrong{};              ///< the current fits no load of this joint
  bool is_to_own{};                  ///< the expected friction is the joint's own when it was sound
};

/// Joints of an arm that are built and warmed alike: from the base to the elbow, and the wrists.
struct JointGroup
{
  std::size_t begin{};
  std::size_t end{};     ///< one past the last joint
  double median{ 1.0 };  ///< median ratio of the joints' friction, apart from the factor of the whole arm
  bool is_known{};       ///< most of at least three joints agree on the median
};

/// Common factors of the friction of an arm's joints.
struct ArmFriction
{
  std::vector<double> factors;        ///< factor of each joint: that of the arm times that of its group
  std::vector<double> deviations;     ///< standard deviation of each factor's logarithm; 0: other joints witness it [-]
  double median{ 1.0 };               ///< factor of the whole arm; 1: the joints have nothing in common
  std::optional<double> temperature;  ///< temperature that explains the factor; none: it is not within 0 ... 60 degC
  std::vector<JointGroup> groups;
  bool is_known{};  ///< enough joints show their friction
  Misfit misfit;    ///< why none of the joints is judged
};

/// The factor of the whole arm is the median joint's, if most of at least three joints agree on it within `tolerance`
/// and it differs from 1 by more than that. One faulty joint then changes neither the factor nor the temperature.
/// A group has a factor of its own if most of its three joints agree on what the factor of the arm leaves, because
/// three drives do not fail alike. Joints that are compared with their type differ by more than joints that are
/// compared with themselves: 5 % of the group's factor may be chance. That is the deviation of a joint that is compared
/// with itself while others of its group are not. If a group has more friction than expected, no joint of it counts as
/// one with less. If a group has less friction than expected, its joints count as joints with more, and the scatter of
/// the group's other joints beyond that of sound joints is a deviation too.
/// No joint is judged in three cases. If the friction of two joints or more is below what any fault leaves, something
/// else carries the arm. If the currents of two or more fit no load, or if one does not and the friction of another is
/// below what any fault leaves, the load of the arm is another one. If the friction of one joint is below what any
/// fault leaves and that of another is more than twice the expected, the joints are in another order.
ArmFriction commonFriction(const std::vector<MeasuredFriction>& joints, double tolerance);

/// Why a joint is not judged: its own reason, or else that of all joints. Wrong signs of the efforts explain a load
/// that does not fit, so the reason of all joints then counts.
inline const Misfit& misfitOf(const Misfit& joint, const Misfit& arm)
{
  const bool is_sign = joint.reason == Reason::LOAD_WRONG && arm.reason == Reason::EFFORT_NOT_CURRENT;
  return !joint.exists() || (arm.exists() && is_sign) ? arm : joint;
}
}  // namespace hjt
