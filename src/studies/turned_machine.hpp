// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"

namespace hjt
{
/// One element on a ring under load, and on the same ring with the whole machine turned by random angles.
/// Differences: the largest found, forces turned back before they are compared.
struct TurnedElement
{
  std::string name;
  double force_max{};          ///< on a tooth, machine not turned [N]
  double force_difference{};   ///< [N]
  double energy{};             ///< machine not turned [J]
  double energy_difference{};  ///< [J]
  double torque_difference{};  ///< on wave generator or output [N.m]
};

/// Both laws of the rim's bending on that ring, turned by one angle.
struct TurnedBending
{
  double angle{};             ///< [rad]
  double curvature_force{};   ///< largest bending force of a segment, law `curvature` [N]
  double absolute_force{};    ///< the same, law `absolute` [N]
  double curvature_energy{};  ///< [J]
  double absolute_energy{};   ///< [J]
};

struct TurnedMachine
{
  SolveStatus status;
  std::vector<TurnedElement> elements;
  std::vector<TurnedBending> bending;
};

/// The ring in equilibrium under `load` [N.m], turned by `samples` random angles and, for the bending laws, by
/// `samples` angles from -0.5 to 0.5 rad. The cup is left out: it is held by the housing, which has no angle of its own
/// here; a turn by whole tooth pitches with the housing is the renumbering of `analyseState`.
TurnedMachine analyseTurnedMachine(const Parameters& parameters, double load, unsigned seed, int samples);
}  // namespace hjt
