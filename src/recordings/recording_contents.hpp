// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recordings/decimated.hpp"

#include "recordings/recorded_motion.hpp"

namespace hjt
{
/// A topic or column that a comparison can use.
struct ContentLine
{
  std::string name;
  std::string gives;
  std::uint64_t messages{};  ///< rows of a CSV file; of temperatures: rows that have one
  bool found{};
};

/// Contents of a recording.
struct RecordingContents
{
  std::vector<ContentLine> lines;
  std::vector<std::string> joints;        ///< named in the telemetry's first message
  std::vector<std::string> other_topics;  ///< that a comparison does not use
};

/// One instant of the twin that ran when the bag was made.
struct TwinState
{
  double time{};           ///< since the first row of the telemetry [s]
  double position{};       ///< of the joint [rad]
  double velocity{};       ///< [rad/s]
  double motor_current{};  ///< [A]
};

/// `twin_topic`: the joint states of a twin that was recorded beside the robot. `count`: of the reading;
/// `temperature_rows`: those with a received temperature.
/// @throws InputError if the file cannot be read.
RecordingContents readContents(const MotionSource& source, const std::string& twin_topic, const MotionCount& count,
                               std::uint64_t motor_rows, std::uint64_t temperature_rows, bool has_load);

/// The twin's recorded states; none where the recording has no such topic, or it is the telemetry itself.
Decimated<TwinState> readTwinStates(const MotionSource& source, const std::string& twin_topic, double start);
}  // namespace hjt
