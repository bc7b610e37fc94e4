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
/// A response surface, or the reason why there is none.
struct SurfaceBuild
{
  SurfaceTable table;
  std::string failure_reason;  ///< reason why there is no table; empty: the table is valid
  int solves{};                ///< number of solved equilibria of the ring
};

/// Tabulates the ring in equilibrium from no load to twice the torque that load or motor can apply, in both directions.
///
/// Measured errors determine the grid. An interval is halved if at its middle the torques or the mean friction of table
/// and ring differ by more than a tolerance. `model` must repeat after every tooth pitch. There is no table if the ring
/// of `model` has no equilibrium at the torque limits, or if the table would have more than `max_points` points. The
/// calling thread calls `progress`, which may be empty, with 0 ... 1. The bits of the table do not depend on the number
/// of `threads`.
SurfaceBuild buildSurface(const Parameters& parameters, const JointModel& model,
                          const std::function<void(double)>& progress, std::size_t max_points = MAX_SURFACE_POINTS,
                          unsigned threads = processors());

/// Tabulates forces and positions of the teeth. `coarse`: v of lines that the ring can reach in steps of `step` [rad],
/// one of them at no load; the table ends at the outermost of these lines. `mirrored`: the gear has mirror symmetry,
/// and `coarse` has only v >= 0.
///
/// Columns and lines are doubled until the values between them meet the tolerance. The tolerance of a force is
/// TOOTH_FORCE_SHARE of the largest force of its quantity, or LEAST_TOOTH_FORCE if this is larger. `solves`: increased
/// by each solve. The result has no lines if the ring has no equilibrium or the table would exceed MAX_TOOTH_VALUES.
ToothResponse buildToothResponse(const SurfaceParameters& parameters, const JointModel& model,
                                 const std::vector<double>& coarse, double step, bool mirrored, unsigned threads,
                                 std::atomic<int>& solves);

constexpr double TOOTH_FORCE_SHARE = 0.01;                        ///< tolerance over the largest force [-]
constexpr double LEAST_TOOTH_FORCE = 0.5;                         ///< least tolerance of a tooth's force [N]
constexpr std::size_t MAX_TOOTH_VALUES = std::size_t{ 1 } << 24;  ///< number of values as float: 64 MB

/// Largest number of points of a table of deviations: 250 MB. A slightly cracked rim needs a sixth of these points.
constexpr std::size_t MAX_DEVIATION_POINTS = 1500000;

/// Deviations of a gear from the gear with equal teeth, or the reason why there is no table of them.
struct DeviationBuild
{
  DeviationTable table;
  std::string failure_reason;  ///< reason why there is no table; empty: the table is valid
  int solves{};                ///< number of solved equilibria of the ring
};

/// Tabulates the values of the ring of `actual` minus those of the ring of `equal`, for v of `lowest` ... `highest`
/// [rad].
///
/// `repetition`: see SurfaceRing. Measured errors determine the grid as in buildSurface, but the tolerance is relative
/// to the size of the deviations, within the accuracy of the surface. `progress`, `max_points`, `threads`: see
/// buildSurface.
DeviationBuild buildDeviations(const Parameters& parameters, const JointModel& equal, const JointModel& actual,
                               int repetition, double lowest, double highest,
                               const std::function<void(double)>& progress,
                               std::size_t max_points = MAX_DEVIATION_POINTS, unsigned threads = processors());

/// Table of the effect of a dropped ball on a gear, or the reason why there is no table.
struct BallBuild
{
  BallTable table;
  std::string failure_reason;  ///< reason why there is no table; empty: the table is valid
};

/// Tabulates the effect of a ball that drops by up to `deepest` [m], for v of `lowest` ... `highest` [rad].
///
/// `sound`: gear without a fault of the bearing that repeats after every tooth pitch. `progress`, `threads`: see
/// buildSurface.
BallBuild buildBallTable(const Parameters& parameters, const JointModel& sound, double deepest, double lowest,
                         double highest, const std::function<void(double)>& progress, unsigned threads = processors());
}  // namespace hjt
