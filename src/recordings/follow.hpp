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
  std::string out;  ///< CSV file of every row, for an arm a directory; empty: none
  std::string bag;  ///< bag with the topics of a node that runs beside a robot; empty: none
  /// Gets every row of every joint, with the joint's number.
  std::function<void(std::size_t, const Comparison&)> take{ [](std::size_t, const Comparison&) {} };
};

void addOptions(OptionTable& table, FollowOptions& options);

/// A joint beside its healthy twin. A residual is measured less predicted, as root mean square.
struct FollowedJoint
{
  std::string name;  ///< short name
  TrackerCounters counters;
  StreamTimingReport timing;
  std::optional<double> lag;         ///< delay of the measurement behind its prediction [s]
  double current_rms{};              ///< measured current [A]
  double current_residual_rms{};     ///< residual of the current [A]
  double velocity_residual_rms{};    ///< residual of the speed [rad/s]
  double position_residual_rms{};    ///< residual of the angle [rad]
  std::optional<double> load_error;  ///< computed load less recorded load; none if one is not known [N.m]
};

struct Followed
{
  bool is_arm{};
  std::string load;  ///< load of an arm's joints: LOAD_OF_ARM or LOAD_RECORDED
  MotionFindings found;
  std::vector<FollowedJoint> joints;  ///< joints from the base on; none if stopped before the first row
};

/// Runs healthy twins beside the recording of a joint or an arm, and writes the files of the options.
/// @throws ParameterError, InputError if a file cannot be read or written.
Followed follow(const FollowOptions& options);

Report reportOf(const Followed& followed);
}  // namespace hjt
