// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "tracking/reason.hpp"

namespace hjt
{
/// By which the temperature of a drive, and what else the joints of an arm have in common, changes friction from day to
/// day, where no other joints tell: standard deviation of the logarithm [-].
constexpr double UNWITNESSED = 0.06;
/// Of common factors of the joints, from which on they are no witnesses: standard deviation of the logarithm, as much
/// as three joints of their type may have in common by chance [-].
constexpr double NO_WITNESS = 0.05;

/// Joints that witness for each other, at least.
constexpr std::size_t MIN_WITNESSES = 3;

/// How many of an arm's joints are from the base to the elbow; the others are the wrists.
inline std::size_t jointsToElbow(std::size_t joints)
{
  return (joints + 1) / 2;
}

/// Friction of one joint of an arm.
struct MeasuredFriction
{
  std::optional<double> ratio;       ///< measured over expected; none: not known
  double temperature{};              ///< that it is expected at [degC]
  bool temperature_received{};       ///< that one was
  std::function<double(double)> at;  ///< the twin's at a temperature [degC], in the motion that was measured [N.m]
  bool is_below_faults{};            ///< less than any fault leaves of it
  bool is_none{};                    ///< friction is nearly zero
  bool is_against{};                 ///< the current goes against the motion's
  bool is_load_wrong{};              ///< the current fits no load of this joint
  bool is_to_own{};                  ///< the expected one is the joint's own when it was sound
};

/// Joints of an arm that are built and warmed alike: from the base to the elbow, and the wrists.
struct JointGroup
{
  std::size_t begin{};
  std::size_t end{};     ///< one past the last
  double median{ 1.0 };  ///< of the joints' friction, apart from that of the arm
  bool is_known{};       ///< most of at least three agree on it
};

/// Common factors of the friction of an arm's joints.
struct ArmFriction
{
  std::vector<double> factors;        ///< of each joint, that of its group in it
  std::vector<double> deviations;     ///< of the factors, standard deviation of the logarithm; 0: witnessed [-]
  double median{ 1.0 };               ///< of the joints; 1: they have nothing in common
  std::optional<double> temperature;  ///< that it means by the twins' law of friction; none: not within 0 ... 60 degC
  std::vector<JointGroup> groups;
  bool is_known{};  ///< enough joints show their friction
  Misfit misfit;    ///< of all joints
};

/// The joints are judged after what most of at least three agree on within `tolerance`: nothing, or one factor that
/// differs from 1 by more than that. Factor and temperature are the median joint's, so that one faulty joint changes
/// neither. What is left then and most of the three joints of a group agree on is the group's: three drives do not fail
/// alike. Joints held against their type differ by more, and 5 % of it may be chance: of a joint that is held against
/// its own while others are not, that is the deviation. More friction of the others makes no joint's less; less of the
/// others makes it more by as much as they agree on: what they scatter by, beyond what sound joints do, is a deviation
/// too. Two joints or more whose friction is below what any fault leaves: something else carries the arm. Two or more
/// whose currents fit no load, or one and one of the former: its load is another. One of the former, and one with more
/// than twice what is expected of it: they are in another order. In all these cases no joint is judged.
ArmFriction commonFriction(const std::vector<MeasuredFriction>& joints, double tolerance);

/// Why a joint is not judged: its own reason, or that of all joints. Signs of efforts tell more than another load.
inline const Misfit& misfitOf(const Misfit& joint, const Misfit& arm)
{
  const bool is_sign = joint.reason == Reason::LOAD_WRONG && arm.reason == Reason::EFFORT_NOT_CURRENT;
  return !joint.exists() || (arm.exists() && is_sign) ? arm : joint;
}
}  // namespace hjt
