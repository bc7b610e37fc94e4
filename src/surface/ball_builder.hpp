// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "model/joint_model.hpp"
#include "solver/ball_drops.hpp"
#include "surface/parallel_tasks.hpp"

namespace hjt
{
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
