// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// A health indicator that cannot always be given. The value is 0 while it is not valid.
struct Indicator
{
  bool valid{};
  double value{};
};
}  // namespace hjt
