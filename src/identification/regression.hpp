// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <ceres/problem.h>
#include <Eigen/Core>

namespace hjt
{
/// Solves a problem. Returns half widths of the 95 % intervals of the parameters named, one value each, widened by the
/// residual's correlation; rows in the order in which they were added, one residual each.
Eigen::VectorXd solve(ceres::Problem& problem, const std::vector<double*>& parameters, int most_iterations);

/// "12 %"
std::string percentText(double share);
}  // namespace hjt
