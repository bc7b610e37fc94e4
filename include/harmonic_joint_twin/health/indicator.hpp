// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// A health indicator with its validity. The value is 0 if it is not valid.
struct Indicator
{
  bool valid{};
  double value{};
};
}  // namespace hjt
