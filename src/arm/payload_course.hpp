// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "arm/arm_description.hpp"

namespace hjt
{
/// From a time on that payload is carried.
struct PayloadFrom
{
  double time{};  ///< [s]
  Payload payload;
};

/// What an arm carries one after the other, in order of time; empty: what it is configured with.
using PayloadCourse = std::vector<PayloadFrom>;
}  // namespace hjt
