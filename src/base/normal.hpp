// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
// Of a normal distribution, over its standard deviation.
constexpr double NORMAL_95 = 1.96;        ///< half width of the 95 % interval
constexpr double NORMAL_MEDIAN = 0.6745;  ///< median size
}  // namespace hjt
