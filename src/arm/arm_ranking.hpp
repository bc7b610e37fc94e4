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
  static constexpr double CLEARLY = 15.0;       ///< difference of two costs that makes an arm clearly likelier [-]
  static constexpr double CONTRADICTED = 20.0;  ///< difference of two costs that makes the given arm wrong [-]
  static constexpr double EXPLAINED = 0.35;  ///< the true arm leaves at most this share of the currents unexplained [-]
  static constexpr double ENOUGH = 120.0;    ///< longest motion that a ranking uses [s]

  std::string arm;
  EffortUnit unit{};  ///< unit of the efforts that fits best
  /// factor that the currents of all joints have in common; 1 if it is within the scatter of gains of one type [-]
  double size{ 1.0 };
  double left{};  ///< share of the moving joints' currents that the best payload and mounting do not explain, rms [-]
  double cost{};  ///< negative logarithm of the likelihood of the rows with this arm [-]

  bool operator<(const ArmFit& other) const { return cost < other.cost; }
  /// Whether this arm explains the currents, and its cost is lower than that of `other` by more than `by`.
  bool isBetter(const ArmFit& other, double by) const { return left < EXPLAINED && cost < other.cost - by; }
};

/// An arm to which the rows may belong.
struct ArmCandidate
{
  std::string name;
  ArmDescription arm;
  std::vector<Parameters> joints;  ///< parameters of the joints, with the load that the arm gives
  double cost{};                   ///< cost by knowledge other than the rows, in the unit of ArmFit::cost [-]
};

/// A function that takes one row of each joint, all of one time. MotionRow::current holds the effort as recorded.
using VisitArmRows = std::function<void(const std::vector<MotionRow>&)>;
/// A function that gives all rows to the visitor, the earliest first. Each call gives the same rows.
using PlayArmRows = std::function<void(const VisitArmRows&)>;

/// Ranks the candidates by how well they explain the rows, the best first. Each candidate gets the payload, mounting
/// and friction that fit best, and gains within the scatter of one type. All currents may have a common factor if it
/// makes the rows much likelier. With `unit_is_given` the efforts have the configured unit. @throws ParameterError.
std::vector<ArmFit> rankArms(const std::vector<ArmCandidate>& candidates, const PlayArmRows& play, bool unit_is_given);

/// A function that ranks the arms with the given names, the best first.
using RankArms = std::function<std::vector<ArmFit>(const std::vector<std::string>&)>;
/// Name of the arm that explains the rows better than the arm `own` by more than ArmFit::CONTRADICTED; empty: no arm
/// does. `names` contains `own`. If no arm could explain the rows so much better, the function ranks no other arm.
std::string betterArm(const std::string& own, std::vector<std::string> names, const RankArms& rank);

/// The clause "the arm may be a ur5e, which explains ...", with `other` as the name of the arm.
std::string otherArmText(const std::string& other);
/// Gives a misfit that names the arm `other` to each joint that has no misfit, or the misfit LOAD_WRONG.
void nameOtherArm(const std::string& other, std::vector<Misfit>& misfits);
/// Whether a joint has no misfit, or the misfit LOAD_WRONG, so that the arm may be another than the given one.
bool mayBeOtherArm(const std::vector<Misfit>& misfits);
}  // namespace hjt
