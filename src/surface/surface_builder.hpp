// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "model/joint_model.hpp"
#include "solver/response_surface.hpp"
#include "solver/surface_tables.hpp"
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

/// Effect of a dropped ball on a gear, or why there is no table of it.
struct BallBuild
{
  BallTable table;
  std::string failure_reason;  ///< empty: the table is good
};

/// Tabulates a ball that drops by up to `deepest` [m], at v of `lowest` ... `highest` [rad].
///
/// `sound`: the gear with a bearing without fault, the same again after every tooth pitch. `progress`: called from this
/// thread with 0 ... 1, or empty. The bits do not depend on the number of `threads`.
BallBuild buildBallTable(const Parameters& parameters, const JointModel& sound, double deepest, double lowest,
                         double highest, const std::function<void(double)>& progress, unsigned threads = processors());
}  // namespace hjt
