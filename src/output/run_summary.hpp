// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// Start of the simulated time where no recording gives one, so that stamps are valid ROS times: 2001-09-09 01:46:40
/// UTC.
constexpr Stamp SIMULATION_EPOCH = 1'000'000'000'000'000'000;

/// Tells on stderr of a number of things, unless it is 0.
void warn(std::uint64_t count, const std::string& what);

/// Tells on stderr of all that was not as it should be.
void warnOf(const TwinCounters& counters);

/// How a run of the twin ended, for the user and for programs.
struct RunSummary
{
  std::string output;  ///< file written
  Stamp begin{};
  std::chrono::steady_clock::time_point started{ std::chrono::steady_clock::now() };

  /// Prints (JSON on stdout if asked), warns on stderr of all that was not as it should be, and gives the exit code.
  int report(const Twin& twin, bool json) const;
};

/// Names the file that was written to people, tells of an interrupt, and gives the exit code.
int reportWritten(const std::string& output, bool json);
}  // namespace hjt
