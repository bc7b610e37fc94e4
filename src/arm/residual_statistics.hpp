// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace hjt
{
/// Standard deviation of residuals whose outliers do not count: by their median size, as of a normal distribution.
double robustDeviation(const Eigen::VectorXd& residuals);

/// 1 + 2 sum of the correlations until they first turn negative.
double correlationRows(const Eigen::VectorXd& residuals);

/// Half width of the 95 % interval of a normal distribution over its standard deviation.
constexpr double NORMAL_95 = 1.96;
}  // namespace hjt
