// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <vector>

#include "solver/tooth_response.hpp"
#include "surface/surface_ring.hpp"

namespace hjt
{
/// Tabulates forces and places of the teeth between the outermost of `coarse`, the v of lines that the ring can be led
/// to by steps of `step` [rad], no load among them. `mirrored`: those of v >= 0, and the gear is its own mirror image.
///
/// Columns and lines are doubled until what lies between them is right: each force within FORCE_SHARE of the largest of
/// its kind there, or within LEAST_FORCE. `solves`: counts equilibria. No lines: an equilibrium was not found again, or
/// the table would be larger than MAX_TOOTH_VALUES.
ToothResponse buildToothResponse(const SurfaceParameters& parameters, const JointModel& model,
                                 const std::vector<double>& coarse, double step, bool mirrored, unsigned threads,
                                 std::atomic<int>& solves);

constexpr double TOOTH_FORCE_SHARE = 0.01;                        ///< [-]
constexpr double LEAST_TOOTH_FORCE = 0.5;                         ///< [N]
constexpr std::size_t MAX_TOOTH_VALUES = std::size_t{ 1 } << 24;  ///< floats: 64 MB
}  // namespace hjt
