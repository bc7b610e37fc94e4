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
  Eigen::VectorXd norm;        ///< of each parameter's column; 0: nothing depends on it
  Eigen::VectorXd tolerance;   ///< share of each column's square that the others do not explain
  Eigen::VectorXd half_width;  ///< of each parameter's 95 % interval, widened by the residual's correlation
  double correlation_rows{};   ///< rows after which the residual forgets itself
};

/// At a problem's present values, by the parameters named, one value each; rows in the order in which they were added, one
/// residual each.
Regression regress(ceres::Problem& problem, const std::vector<double*>& parameters);

/// 1 + 2 sum of the correlations until they first turn negative.
double correlationRows(const Eigen::VectorXd& residuals);

/// Half width of the 95 % interval of a normal distribution over its standard deviation.
constexpr double NORMAL_95 = 1.96;

/// "12 %"
std::string percentText(double share);
}  // namespace hjt
