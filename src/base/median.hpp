// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

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
}  // namespace hjt
