// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// Between two warnings of the same kind [s].
constexpr double WARNING_PERIOD = 5.0;
}  // namespace hjt
