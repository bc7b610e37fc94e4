// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// Member of TwinCounters that counts steps, with its name in records and in Python.
struct StepCounter
{
  const char* name;
  std::uint64_t TwinCounters::*count;
};

inline constexpr std::array<StepCounter, 10> STEP_COUNTERS{ { { "steps", &TwinCounters::steps },
                                                              { "solver_failures", &TwinCounters::solver_failures },
                                                              { "step_cuts", &TwinCounters::step_cuts },
                                                              { "jumps", &TwinCounters::jumps },
                                                              { "coarse_steps", &TwinCounters::coarse_steps },
                                                              { "torque_clamped", &TwinCounters::torque_clamped },
                                                              { "load_clamped", &TwinCounters::load_clamped },
                                                              { "overloads", &TwinCounters::overloads },
                                                              { "speed_limited", &TwinCounters::speed_limited },
                                                              { "command_timeouts",
                                                                &TwinCounters::command_timeouts } } };
}  // namespace hjt
