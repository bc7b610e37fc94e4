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

/// Standard deviation of residuals whose outliers do not count: by their median size, as of a normal distribution.
double robustDeviation(const Eigen::VectorXd& residuals);

/// 1 + 2 sum of the correlations until they first turn negative.
double correlationRows(const Eigen::VectorXd& residuals);

/// Half width of the 95 % interval of a normal distribution over its standard deviation.
constexpr double NORMAL_95 = 1.96;

/// "12 %"
std::string percentText(double share);
}  // namespace hjt
