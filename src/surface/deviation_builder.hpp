// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "model/joint_model.hpp"
#include "solver/response_surface.hpp"
#include "surface/parallel_tasks.hpp"

namespace hjt
{
/// No table of deviations has more: 250 MB; a rim with a small crack needs a sixth of it.
constexpr std::size_t MAX_DEVIATION_POINTS = 1500000;

/// SurfaceDeviations of a gear from one of equal teeth, or why there are none.
struct DeviationBuild
{
  DeviationTable table;
  std::string failure_reason;  ///< empty: the table is good
  int solves{};                ///< equilibria of the ring that were found for it
};

/// Tabulates by how much the ring of `actual` differs from that of `equal`, whose surface has the range `lowest` ...
/// `highest` of v [rad].
///
/// `repetition`: see SurfaceRing. The grid follows from measured errors, as that of the surface does, but against the
/// size of the deviations, as far as the surface itself is right. `progress`: called from this thread with 0 ... 1,
/// or empty. A table of more than `max_points` is given up. The bits do not depend on the number of `threads`.
DeviationBuild buildDeviations(const Parameters& parameters, const JointModel& equal, const JointModel& actual,
                               int repetition, double lowest, double highest,
                               const std::function<void(double)>& progress,
                               std::size_t max_points = MAX_DEVIATION_POINTS, unsigned threads = processors());
}  // namespace hjt
