// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/response_surface.hpp"

namespace hjt
{
/// A response surface, or why there is none.
struct SurfaceBuild
{
  SurfaceTable table;
  std::string obstacle;  ///< empty: the table is good
  int solves{};          ///< equilibria of the ring that were found for it
};

/// Why the ring of these parameters has no response surface, as far as a turn with equal steps of one tooth pitch under
/// load tells: its torques must come back after every step. Empty: nothing against it. Some ten milliseconds.
std::string surfaceObstacle(const Parameters& parameters);

/// Tabulates the ring in equilibrium from no load to twice the torque that load or motor can bring, both ways.
///
/// The grid follows from measured errors: wherever the table's torques at the middle of an interval miss the ring's by
/// more than a tolerance, the interval is halved. There is no surface for a gear that is not the same again after every
/// tooth pitch, which is tried over a whole turn, or whose ring finds no equilibrium at the torques of its limits.
/// `progress`: called with 0 ... 1, or empty.
SurfaceBuild buildSurface(const Parameters& parameters, const std::function<void(double)>& progress);
}  // namespace hjt
