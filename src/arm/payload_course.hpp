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

/// Payloads of an arm in order of time; empty: the configured one.
using PayloadCourse = std::vector<PayloadFrom>;
}  // namespace hjt
