// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "base/median.hpp"
#include "base/normal.hpp"

namespace hjt
{
/// Standard deviation of residuals whose outliers do not count: by their median size, as of a normal distribution.
inline double robustDeviation(const Eigen::VectorXd& residuals)
{
  const Eigen::VectorXd sizes = residuals.cwiseAbs();
  std::vector<double> sorted(sizes.data(), sizes.data() + sizes.size());
  return upperMedian(sorted.begin(), sorted.end()) / NORMAL_MEDIAN;
}

/// 1 + 2 sum of the correlations until they first turn negative.
inline double correlationRows(const Eigen::VectorXd& residuals)
{
  const Eigen::Index rows = residuals.size();
  const double power = residuals.squaredNorm();
  double length = 1.0;
  for (Eigen::Index lag = 1; lag < rows / 4 && power > 0.0; ++lag)
  {
    const double correlation = residuals.head(rows - lag).dot(residuals.tail(rows - lag)) / power;
    if (correlation <= 0.0)
    {
      break;
    }
    length += 2.0 * correlation;
  }
  return length;
}
}  // namespace hjt
