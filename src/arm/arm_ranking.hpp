// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "arm/arm_description.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/motion_differentiator.hpp"
#include "tracking/reason.hpp"

namespace hjt
{
/// How well an arm explains the currents of a recording.
struct ArmFit
{
  static constexpr double CLEARLY = 15.0;       ///< by which one is likelier, logarithm
  static constexpr double CONTRADICTED = 20.0;  ///< likewise, than the arm that is given
  static constexpr double EXPLAINED = 0.35;     ///< of the currents left, at most, where an arm may be the one [-]
  static constexpr double ENOUGH = 120.0;       ///< of the rows that are looked at [s]

  std::string arm;
  EffortUnit unit{};   ///< of the efforts, that fits best
  double size{ 1.0 };  ///< of all currents, as a multiple of those of that unit: another unit or gain of all [-]
  double left{};       ///< of the currents of the moving joints, with the best payload and mounting, share, rms [-]
  double cost{};       ///< logarithm of a likelihood: less is likelier [-]

  bool operator<(const ArmFit& other) const { return cost < other.cost; }
  /// `by`: logarithm by which it is likelier at least.
  bool isBetter(const ArmFit& other, double by) const { return left < EXPLAINED && cost < other.cost - by; }
};

/// An arm that rows may be of.
struct ArmCandidate
{
  std::string name;
  ArmDescription arm;
  std::vector<Parameters> joints;  ///< their load is that of the arm
  double cost{};                   ///< negative log likelihood of the rows [-]
};

/// Rows of all joints at one time, `current` the effort as it comes.
using VisitArmRows = std::function<void(const std::vector<MotionRow>&)>;
/// Visits the same rows, the earliest first, each time that it is called.
using PlayArmRows = std::function<void(const VisitArmRows&)>;

/// The best first: how each explains the rows with the payload and the mounting that fit it best, gains within what
/// those of a type differ by, any friction, and, where that is much likelier, all currents of another size. Where
/// `unit_is_given` efforts are of the configured unit. @throws ParameterError.
std::vector<ArmFit> rankArms(const std::vector<ArmCandidate>& candidates, const PlayArmRows& play, bool unit_is_given);

/// Ranks the arms of these names, the best first.
using RankArms = std::function<std::vector<ArmFit>(const std::vector<std::string>&)>;
/// Of these names, the one that explains the rows so much better than `own`, which is one of them, that it contradicts
/// it; empty: none. Where `own` explains them so well that none could, no other is tried.
std::string betterArm(const std::string& own, std::vector<std::string> names, const RankArms& rank);

/// "the arm may be a ur5e: ..."
std::string otherArmText(const std::string& other);
/// Nothing is judged of a joint that the load may be wrong for, where the arm may be the `other`.
void nameOtherArm(const std::string& other, std::vector<Misfit>& misfits);
/// Whether a joint's misfit may be that of another arm.
bool mayBeOtherArm(const std::vector<Misfit>& misfits);
}  // namespace hjt
