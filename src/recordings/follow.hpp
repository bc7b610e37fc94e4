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
  std::string out;  ///< CSV file of every row; for an arm, a directory with a file for each joint; empty: no file
  std::string bag;  ///< bag with the topics of a node that runs beside a robot; empty: no bag
  /// Function that is called for every row of every joint, with the joint's number and the comparison.
  std::function<void(std::size_t, const Comparison&)> take{ [](std::size_t, const Comparison&) {} };
};

void addOptions(OptionTable& table, FollowOptions& options);

/// Comparison of a joint with its sound twin. A residual is the rms of measured less predicted values.
struct FollowedJoint
{
  std::string name;  ///< short name of the joint
  TrackerCounters counters;
  StreamTimingReport timing;
  std::optional<double> lag;       ///< delay of the measurement relative to its prediction [s]
  double current_rms{};            ///< measured current, rms [A]
  double current_residual_rms{};   ///< residual of the current, rms [A]
  double velocity_residual_rms{};  ///< residual of the speed, rms [rad/s]
  double position_residual_rms{};  ///< residual of the angle, rms [rad]
  /// computed load less recorded load, rms; none if one of the loads is not known [N.m]
  std::optional<double> load_error;
};

struct Followed
{
  bool is_arm{};
  std::string load;  ///< load of an arm's joints: LOAD_OF_ARM or LOAD_RECORDED
  MotionFindings found;
  std::vector<FollowedJoint> joints;  ///< joints from the base on; none if the program was stopped before the first row
};

/// Runs sound twins beside the recording of a joint or an arm, and writes the files that the options name.
/// @throws ParameterError, InputError if a file cannot be read or written.
Followed follow(const FollowOptions& options);

Report reportOf(const Followed& followed);
}  // namespace hjt
