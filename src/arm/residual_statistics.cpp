// SPDX-License-Identifier: BSD-3-Clause
#include "arm/residual_statistics.hpp"

#include <vector>

#include "base/median.hpp"

namespace hjt
{
double correlationRows(const Eigen::VectorXd& residuals)
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

double robustDeviation(const Eigen::VectorXd& residuals)
{
  const Eigen::VectorXd sizes = residuals.cwiseAbs();
  std::vector<double> sorted(sizes.data(), sizes.data() + sizes.size());
  constexpr double NORMAL_MEDIAN = 0.6745;
  return upperMedian(sorted.begin(), sorted.end()) / NORMAL_MEDIAN;
}
}  // namespace hjt
