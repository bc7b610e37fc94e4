// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "model/joint_model.hpp"
#include "solver/response_surface.hpp"
#include "surface/parallel_tasks.hpp"
#include "surface/surface_ring.hpp"

namespace hjt
{
/// A response surface, or why there is none.
struct SurfaceBuild
{
  SurfaceTable table;
  std::string failure_reason;  ///< empty: the table is good
  int solves{};                ///< equilibria of the ring that were found for it
};

/// Tabulates the ring in equilibrium from no load to twice the torque that load or motor can bring, both ways.
///
/// The grid follows from measured errors: wherever the table's torques or the mean friction at the middle of an
/// interval miss the ring's by more than a tolerance, the interval is halved. `model` must be the same again after
/// every tooth pitch. There is no surface where its ring finds no equilibrium at the torques of its limits.
/// `progress`: called from this thread with 0 ... 1, or empty. A table of more than `max_points` is given up. The bits
/// of the table do not depend on the number of `threads`.
SurfaceBuild buildSurface(const Parameters& parameters, const JointModel& model,
                          const std::function<void(double)>& progress, std::size_t max_points = MAX_SURFACE_POINTS,
                          unsigned threads = processors());
}  // namespace hjt
