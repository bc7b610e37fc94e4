// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "output/report.hpp"
#include "recordings/recording_options.hpp"

#include "tracking/telemetry_rows.hpp"
#include "tracking/tracker.hpp"

namespace hjt
{
struct FollowOptions : RecordingOptions
{
  InputMode mode{ InputMode::MOTION };
  std::string out;  ///< CSV of every row, of an arm a directory; empty: none
  std::string bag;  ///< with the topics of the node beside a robot; empty: none
  /// Given every row of every joint, by its number.
  std::function<void(std::size_t, const Comparison&)> take{ [](std::size_t, const Comparison&) {} };
};

void addOptions(OptionTable& table, FollowOptions& options);

/// A joint beside its healthy twin; errors as root mean squares, measured less predicted.
struct FollowedJoint
{
  std::string name;  ///< short
  TrackerCounters counters;
  StreamTimingReport timing;
  std::optional<double> lag;         ///< of the measurement behind its prediction [s]
  double current_rms{};              ///< measured [A]
  double current_residual_rms{};     ///< [A]
  double velocity_residual_rms{};    ///< [rad/s]
  double position_residual_rms{};    ///< [rad]
  std::optional<double> load_error;  ///< of the arm's load against the recorded one; none: not both are known [N.m]
};

struct Followed
{
  bool is_arm{};
  std::string load;  ///< of an arm's joints: LOAD_OF_ARM or LOAD_RECORDED
  MotionFindings found;
  std::vector<FollowedJoint> joints;  ///< from the base on; none: stopped before the first row
};

/// Runs healthy joints beside a recording, of a joint or an arm, and writes what is asked for.
/// @throws ParameterError, InputError: unreadable, or a file that cannot be written.
Followed follow(const FollowOptions& options);

Report reportOf(const Followed& followed);
}  // namespace hjt
