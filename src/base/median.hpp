// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hjt
{
/// Of at least one value, the upper of two in the middle. Reorders them, allocates nothing.
template <typename Iterator>
auto upperMedian(Iterator first, Iterator last)
{
  const Iterator middle = first + (last - first) / 2;
  std::nth_element(first, middle, last);
  return *middle;
}

/// Of at least one value, the mean of two in the middle.
inline double medianOf(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}
}  // namespace hjt
