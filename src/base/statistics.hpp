// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hjt
{
// Quantiles of a normal distribution, in units of its standard deviation.
constexpr double NORMAL_95 = 1.96;        ///< half width of the interval with 95 % of the values
constexpr double NORMAL_MEDIAN = 0.6745;  ///< median of the magnitudes of the values

/// Median of one or more values, the upper of the middle two if their number is even. Reorders them; no allocation.
template <typename Iterator>
auto upperMedian(Iterator first, Iterator last)
{
  const Iterator middle = first + (last - first) / 2;
  std::nth_element(first, middle, last);
  return *middle;
}

/// Median of one or more values; of an even number of values, the mean of the middle two.
inline double medianOf(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// Robust standard deviation of residuals. The median of their magnitudes is scaled as for a normal distribution.
template <class Vector>
double robustDeviation(const Vector& residuals)
{
  std::vector<double> sizes(residuals.data(), residuals.data() + residuals.size());
  std::transform(sizes.begin(), sizes.end(), sizes.begin(), [](double residual) { return std::abs(residual); });
  return upperMedian(sizes.begin(), sizes.end()) / NORMAL_MEDIAN;
}

/// Root mean square of the added values.
class Rms
{
public:
  void add(double value)
  {
    squares_ += value * value;
    ++count_;
  }
  double value() const { return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0.0; }

private:
  double squares_{};
  std::uint64_t count_{};
};
}  // namespace hjt
