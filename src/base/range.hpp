// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// Closed interval a value must lie in.
struct Range
{
  double min;
  double max;
};
}  // namespace hjt
