// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <string>

#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
enum ExitCode : int
{
  EXIT_DONE = 0,
  EXIT_FAILED = 1,
  EXIT_USAGE = 2,
  EXIT_DEPARTS = 3,     ///< a verdict has at least the level of the user's option
  EXIT_NOT_JUDGED = 4,  ///< nothing could be judged, although the user's option requires a verdict
  EXIT_STOPPED = 5,     ///< the arm has stopped itself
  EXIT_BY_SIGNAL = 128  ///< plus the number of the signal
};

/// Signal that arrived within an InterruptScope, or 0.
int interruptSignal();

/// During its lifetime, SIGINT, SIGTERM and SIGHUP end loops that check `interruptSignal`, so that files are closed. A
/// second signal ends the process. A nested scope has no effect.
class InterruptScope
{
public:
  InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;
  ~InterruptScope();

private:
  struct Caught
  {
    int signal{};
    struct sigaction before
    {
    };
  };

  static void catchSignal(Caught& caught, int signal);

  const bool is_outer_;
  std::array<Caught, 3> caught_{};  // signal 0: no signal is caught
};

/// Start of the simulated time without a recording: 2001-09-09 01:46:40 UTC, so that stamps are valid ROS times.
constexpr Stamp SIMULATION_EPOCH = 1'000'000'000'000'000'000;

/// Warns on stderr of a number of events, unless it is 0.
void warn(std::uint64_t count, const std::string& what);

/// Warns on stderr of all counted events of a run.
void warnOf(const TwinCounters& counters);

/// Report on the end of a twin's run, for people and programs.
struct RunSummary
{
  std::string output;  ///< path of the written file
  Stamp begin{};
  std::chrono::steady_clock::time_point started{ std::chrono::steady_clock::now() };

  /// Prints the report (as JSON on stdout if `json`), warns on stderr, and returns the exit code.
  int report(const Twin& twin, bool json) const;
};

/// Tells people the name of the written file and an interrupt, and returns the exit code.
int reportWritten(const std::string& output, bool json);
}  // namespace hjt
