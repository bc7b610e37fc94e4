// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "bags/recorded_messages.hpp"
#include "harmonic_joint_twin/base/stamp.hpp"
#include "tracking/motion_differentiator.hpp"
#include "tracking/reason.hpp"
#include "tracking/telemetry_rows.hpp"

namespace hjt
{
/// Number of a joint that has no columns in a controller's table.
constexpr int NO_COLUMNS = -1;

/// A recording, and which of its joints, topics and times to read.
struct MotionSource
{
  std::string path;                      ///< path of a bag, a .db3, .mcap or CSV file, or a directory of ROS 2
  RecordingFormat format{};              ///< format of the recording
  std::string joint;                     ///< name of the joint in the messages
  int csv_joint{};                       ///< number of the joint in the columns of a CSV file
  std::string topic{ "/joint_states" };  ///< topic of the joint states, sensor_msgs/JointState
  std::string load_topic;                ///< topic of the load, sensor_msgs/JointState with the load as effort [N.m]
  /// Current per torque of the motor [A/(N.m)], if the effort of NAME_motor in the messages is a torque, else 0.
  double current_per_motor_torque{};
  /// Motor current per effort of the joint: [-] if the effort is a current, [A/(N.m)] if the effort is a torque.
  double current_per_effort{ 1.0 };
  double time_scale{ 1.0 };  ///< factor by which the times of the recording are multiplied [-]
  /// Largest speed of each joint, which RowFilter uses to refuse angles [rad/s]. A missing entry stands for FASTEST.
  std::vector<double> speeds;
  /// Recording in memory; null for a file. It holds a row of each joint at each time, with currents in A.
  std::shared_ptr<const std::vector<std::vector<MotionRow>>> rows;

  static constexpr double FASTEST = 20.0;  ///< speed that no joint of a robot exceeds [rad/s]
};

/// Counts and remarks from reading a recording.
struct MotionCount
{
  std::uint64_t rows{};
  std::uint64_t corrupt{};  ///< messages that cannot be read, lack a finite angle or current, or have impossible values
  LeftOutRows left_out;     ///< rows that RowFilter omitted; the impossible and unreachable ones are also in `corrupt`
  double duration{};        ///< duration of the recording [s]
  Stamp start{};            ///< stamp of the first row [ns]
  double least_delay{};     ///< shortest time from the stamp of a message to its recording [s]
  double most_delay{};      ///< longest time from the stamp of a message to its recording [s]
  std::uint64_t refused_temperatures{};  ///< number of temperatures that are not finite or impossible
  /// Ratio of the first joint's angle rates, computed with the stamps, to its recorded velocities: 1 if both agree [-].
  /// NaN if the ratio is not known.
  double velocity_ratio{ std::numeric_limits<double>::quiet_NaN() };
  std::vector<std::string> remarks;  ///< clauses on repaired or omitted data, without a full stop
  Misfit misfit;                     ///< why no joint can be judged; empty if joints can be judged

  void remark(const std::string& text)
  {
    if (!text.empty())
    {
      remarks.push_back(text);
    }
  }
};

/// Counts and remarks from reading a recording, and counts of the rows after differentiation.
struct MotionFindings : MotionCount
{
  std::uint64_t refused{};  ///< number of rows that the differentiator refused, as repeated or out of order
  std::uint64_t gaps{};     ///< number of gaps longer than MotionDifferentiator::MAX_GAP
  bool has_load{};          ///< whether the recording contains the load
};

inline bool isCsv(const MotionSource& source)
{
  return source.format == RecordingFormat::TABLE;
}

/// Whether the recording contains the load. If not, the load of its rows is zero. @throws InputError if the file cannot
/// be read.
bool recordsLoad(const MotionSource& source);

/// Receives a row of each joint, all with the same time. Returns false if it wants no more rows.
using VisitMotionRows = std::function<bool(const std::vector<MotionRow>& rows)>;

/// Reads a recording row by row. Memory does not grow with the recording, except for the index of a bag. `visit` gets a
/// row for each of `names` at a time: for the source's joint alone, or for all joints of an arm.
///
/// All recordings: RowFilter omits rows that were not measured or are impossible. Times start at the first row; the
/// rounds of a loop follow each other (RowTime). Angles folded into one turn are made continuous (UnfoldedAngle).
/// Messages: times are the stamps of the headers, or times of recording if all stamps are zero. A load counts for rows
/// from its stamp on. The function omits and counts a row without a stamp if other rows have stamps, and a row without
/// efforts if other rows have efforts. It also omits and counts a row that is consistent with neither neighbour: no
/// joint could reach its angle, or its delay from stamp to recording differs by 1 s or more. If two sources publish the
/// same joint, `misfit` says so. A row without all joints is omitted and counted as corrupt. If no message holds all
/// joints, values of the other joints are interpolated to the times of the first joint's rows.
/// The temperature of a row is the latest sensor_msgs/Temperature message of any topic whose frame_id is the joint,
/// unless the message is older than TemperatureRecord allows.
/// Table: columns timestamp, actual_q_N, actual_current_N and target_moment_N, as `joint_twin import` reads them, and
/// joint_temperatures_N [degC]; for an arm, N is 0 to 5 in the order of the names.
/// `progress` is called with the read share of the recording, 0 to 1.
/// @throws InputError if the file, the topic or a joint does not exist; the error names what exists or what is missing.
MotionCount readMotion(const MotionSource& source, const std::vector<std::string>& names, const VisitMotionRows& visit,
                       const std::function<void(double)>& progress);
}  // namespace hjt
