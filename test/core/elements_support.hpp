// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include "element_under_test.hpp"
#include "elements/contact_laws.hpp"
#include "gear/angle.hpp"
#include "random_ring.hpp"
#include "test_parameters.hpp"

namespace hjt
{
/// Nearer to the depth at which Hertz' contact opens, its curvature shows in a difference [m].
constexpr double HERTZ_KINK = 1.5e-7;
}  // namespace hjt
