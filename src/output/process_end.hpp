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
/// The process' answer to the shell.
enum ExitCode : int
{
  EXIT_DONE = 0,
  EXIT_FAILED = 1,
  EXIT_USAGE = 2,
  EXIT_DEPARTS = 3,     ///< a verdict is as bad as the user asked to be told
  EXIT_NOT_JUDGED = 4,  ///< nothing could be judged, and the user asked for a verdict
  EXIT_STOPPED = 5,     ///< the arm stopped by itself
  EXIT_BY_SIGNAL = 128  ///< plus the signal's number
};

/// The signal that came within an InterruptScope, or 0.
int interruptSignal();

/// While it lives, SIGINT, SIGTERM and SIGHUP end loops that ask for `interruptSignal` instead of the process, so
/// that files are closed; a second one ends the process. A scope within another changes nothing.
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
  std::array<Caught, 3> caught_{};  // an entry with signal 0 catches nothing
};

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
