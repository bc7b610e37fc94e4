// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "live/twin_loop.hpp"

#include <gtest/gtest.h>

#include "live/thread_exchange.hpp"
#include "messages/conversions.hpp"
#include "messages/time.hpp"
#include "test/core/test_parameters.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
constexpr Stamp MILLISECOND = 1'000'000;
constexpr Stamp SECOND = 1000 * MILLISECOND;
}  // namespace hjt
