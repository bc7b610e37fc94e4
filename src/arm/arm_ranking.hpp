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
  static constexpr double CLEARLY = 15.0;       ///< logarithm by which an arm is clearly likelier [-]
  static constexpr double CONTRADICTED = 20.0;  ///< logarithm by which another arm contradicts the given one [-]
  static constexpr double EXPLAINED = 0.35;     ///< largest share of the currents that the true arm may leave [-]
  static constexpr double ENOUGH = 120.0;       ///< time of the rows that are looked at [s]

  std::string arm;
  EffortUnit unit{};  ///< unit of the efforts that fits best
  /// factor that the currents of all joints have in common; 1 unless it is too large or too small for the gains of one
  /// type [-]
  double size{ 1.0 };
  double left{};  ///< share of the moving joints' currents that the best payload and mounting leave, rms [-]
  double cost{};  ///< negative logarithm of a likelihood [-]

  bool operator<(const ArmFit& other) const { return cost < other.cost; }
  /// Whether this arm explains the currents and is likelier than `other`, by the logarithm `by` at least.
  bool isBetter(const ArmFit& other, double by) const { return left < EXPLAINED && cost < other.cost - by; }
};

/// An arm that rows may be of.
struct ArmCandidate
{
  std::string name;
  ArmDescription arm;
  std::vector<Parameters> joints;  ///< parameters of the joints, whose load is that of the arm
  double cost{};                   ///< cost by what is known besides the rows, as ArmFit::cost [-]
};

/// Takes a row of each joint, all of one time. The member `current` is the effort as the recording has it.
using VisitArmRows = std::function<void(const std::vector<MotionRow>&)>;
/// Gives all rows to the visitor, the earliest first. Each call gives the same rows.
using PlayArmRows = std::function<void(const VisitArmRows&)>;

/// Ranks the candidates, the best first, by how they explain the rows. Each has the payload and the mounting that fit
/// it best, gains as they differ within a type, and any friction. All currents may have another size if that is much
/// likelier. With `unit_is_given` the efforts are of the configured unit. @throws ParameterError.
std::vector<ArmFit> rankArms(const std::vector<ArmCandidate>& candidates, const PlayArmRows& play, bool unit_is_given);

/// Ranks the arms of these names, the best first.
using RankArms = std::function<std::vector<ArmFit>(const std::vector<std::string>&)>;
/// Name of the arm that explains the rows so much better than `own` that it contradicts `own`; empty if there is none.
/// `names` contains `own`. No other arm is tried if `own` explains the rows so well that none could contradict it.
std::string betterArm(const std::string& own, std::vector<std::string> names, const RankArms& rank);

/// The clause "the arm may be a ur5e: ...".
std::string otherArmText(const std::string& other);
/// Gives a misfit that names the arm `other` to each joint whose load may be wrong.
void nameOtherArm(const std::string& other, std::vector<Misfit>& misfits);
/// Whether the misfit of a joint may come from another arm than the given one.
bool mayBeOtherArm(const std::vector<Misfit>& misfits);
}  // namespace hjt
