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
  EXIT_DEPARTS = 3,     ///< the verdict is at least as bad as the level of --fail-on
  EXIT_NOT_JUDGED = 4,  ///< no joint could be judged, or with `--fail-on not-judged` at least one could not
  EXIT_STOPPED = 5,     ///< a protective stop ended the motion of the arm
  EXIT_BY_SIGNAL = 128  ///< a signal ended the process; the code is this plus the number of the signal
};

/// Number of the signal that arrived within an InterruptScope; 0 if none arrived.
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
  std::array<Caught, 3> caught_{};  // caught signals; a signal number 0 stands for none
};

/// Start of the simulated time without a recording: 2001-09-09 01:46:40 UTC, so that stamps are valid ROS times.
constexpr Stamp SIMULATION_EPOCH = 1'000'000'000'000'000'000;

/// Prints a warning on stderr: `count`, then the text `what`. Prints nothing if `count` is 0.
void warn(std::uint64_t count, const std::string& what);

/// Prints a warning on stderr for each kind of event that a run has counted.
void warnOf(const TwinCounters& counters);

/// Report at the end of a twin's run, for people and programs.
struct RunSummary
{
  std::string output;  ///< path of the written file
  Stamp begin{};
  std::chrono::steady_clock::time_point started{ std::chrono::steady_clock::now() };

  /// Prints the report on stdout (as JSON if `json`) and warnings on stderr. @returns the exit code.
  int report(const Twin& twin, bool json) const;
};

/// Prints the name of the written file, and whether an interrupt ended the run. @returns the exit code.
int reportWritten(const std::string& output, bool json);
}  // namespace hjt
