// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "base/statistics.hpp"

namespace hjt
{
/// Standard deviation of residuals whose outliers do not count: by their median size, as of a normal distribution.
inline double robustDeviation(const Eigen::VectorXd& residuals)
{
  const Eigen::VectorXd sizes = residuals.cwiseAbs();
  std::vector<double> sorted(sizes.data(), sizes.data() + sizes.size());
  return upperMedian(sorted.begin(), sorted.end()) / NORMAL_MEDIAN;
}

/// 1 + 2 sum of the correlations until they first turn negative: rows that tell as much as one. Takes as long as a
/// Fourier transform of the rows.
double correlationRows(const Eigen::VectorXd& residuals);
}  // namespace hjt
