// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <ceres/problem.h>
#include <Eigen/Core>

namespace hjt
{
/// What a least-squares solution says about itself.
struct Regression
{
  Eigen::VectorXd residuals;
  Eigen::VectorXd half_width;  ///< of each parameter's 95 % interval, widened by the residual's correlation
  double correlation_rows{};   ///< rows after which the residual forgets itself
};

/// Solves a problem, and says how well by the parameters named, one value each; rows in the order in which they were
/// added, one residual each.
Regression solve(ceres::Problem& problem, const std::vector<double*>& parameters, int most_iterations);

/// 1 + 2 sum of the correlations until they first turn negative.
double correlationRows(const Eigen::VectorXd& residuals);

/// Half width of the 95 % interval of a normal distribution over its standard deviation.
constexpr double NORMAL_95 = 1.96;

/// "12 %"
std::string percentText(double share);
}  // namespace hjt
