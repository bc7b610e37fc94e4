// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "tracking/reason.hpp"

namespace hjt
{
/// Standard deviation of the logarithm of a joint's friction from day to day, if no other joints show the change [-].
/// Temperature and other causes that the joints of an arm share make this change.
constexpr double UNWITNESSED = 0.06;
/// Standard deviation of the logarithm of a common factor by chance: three joints of one type may have as much in
/// common [-]. Joints that share a factor of a larger deviation are no witnesses.
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
  std::optional<double> ratio;       ///< measured over expected friction; none: not known [-]
  double temperature{};              ///< temperature at which the expected friction holds [degC]
  bool temperature_received{};       ///< whether the temperature was measured
  std::function<double(double)> at;  ///< friction of the twin at a temperature [degC] in the measured motion [N.m]
  bool is_below_faults{};            ///< the joint has less friction than any fault leaves
  bool is_none{};                    ///< the joint has nearly no friction
  bool is_against{};     ///< the measured current has the opposite sign of the current that the motion takes
  bool is_load_wrong{};  ///< the measured current fits no load of this joint
  bool is_to_own{};      ///< the expected friction is that of the joint itself when it was sound
};

/// A group of joints that are built and warmed alike: the joints from base to elbow, or the wrists.
struct JointGroup
{
  std::size_t begin{};
  std::size_t end{};     ///< number of the first joint after the group
  double median{ 1.0 };  ///< median of the joints' ratios, apart from the factor of the whole arm [-]
  bool is_known{};       ///< whether the group has at least three joints and most of them agree on the median
};

/// Common factors of the friction of an arm's joints.
struct ArmFriction
{
  std::vector<double> factors;     ///< factor of each joint: factor of the arm times factor of the group [-]
  std::vector<double> deviations;  ///< standard deviation of each factor's logarithm; 0: other joints are witnesses [-]
  double median{ 1.0 };            ///< factor of the whole arm; 1: the joints have no factor in common [-]
  std::optional<double> temperature;  ///< temperature that explains the factor; none: not within 0 ... 60 [degC]
  std::vector<JointGroup> groups;
  bool is_known{};  ///< whether enough joints show their friction
  Misfit misfit;    ///< why no joint of the arm is judged; empty: the joints are judged
};

/// Finds the common factors of an arm's joints. The factor of the whole arm is the median of the joints' ratios, if
/// most of at least three joints agree on it within `tolerance`, and if it differs from 1 by more than `tolerance`. So
/// one faulty joint changes neither the factor nor the temperature.
/// A group has a factor of its own if most of its three joints agree on what the factor of the arm leaves, because
/// three drives do not fail alike. If the joints are compared with their type, 5 % of the group's factor may be chance.
/// If only some joints of a group are compared with themselves, these 5 % are the deviation of their factor. If a group
/// has more friction than expected, no joint of the group counts as a joint with less. If it has less friction, its
/// joints count as joints with more, and the scatter of the group's other joints beyond that of sound joints adds to
/// the deviation.
/// No joint is judged in three cases. If two or more joints have less friction than any fault leaves, something else
/// carries the arm. If the currents of two or more joints fit no load, or those of one joint while another has less
/// friction than any fault leaves, the arm has another load. If one joint has less friction than any fault leaves and
/// another has more than twice the expected friction, the joints are in another order.
ArmFriction commonFriction(const std::vector<MeasuredFriction>& joints, double tolerance);

/// Why a joint is not judged: its own reason, otherwise that of all joints. If the efforts have wrong signs, the reason
/// of all joints comes first, because wrong signs also explain a load that does not fit.
inline const Misfit& misfitOf(const Misfit& joint, const Misfit& arm)
{
  const bool is_sign = joint.reason == Reason::LOAD_WRONG && arm.reason == Reason::EFFORT_NOT_CURRENT;
  return !joint.exists() || (arm.exists() && is_sign) ? arm : joint;
}
}  // namespace hjt
