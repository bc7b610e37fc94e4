// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Rows further apart tell no acceleration: 20 Hz at least, with jitter [s].
constexpr double SLOW_ROWS = 0.06;

/// By which stamps are multiplied that are in ms, us or ns, where rows so far apart [s] mean one of these; 1: they do
/// not.
double likelyTimeScale(double period);

/// For people: "the motor's current in A".
const char* effortUnitName(EffortUnit unit);
/// In configuration.
const char* effortKeyword(EffortUnit unit);
}  // namespace hjt
