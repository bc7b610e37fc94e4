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
/// Number of a joint that is not in a controller's table.
constexpr int NO_COLUMNS = -1;

/// A recording, and the joint in the recording.
struct MotionSource
{
  std::string path;                      ///< bag, .db3, .mcap, their directory, or CSV
  RecordingFormat format{};              ///< format of the recording
  std::string joint;                     ///< name of the joint in the messages
  int csv_joint{};                       ///< number of the joint in the columns of a CSV file
  std::string topic{ "/joint_states" };  ///< topic of the joint states, sensor_msgs/JointState
  std::string load_topic;                ///< topic of the load, sensor_msgs/JointState with the load as effort [N.m]
  /// Current per torque of the motor, if the effort of NAME_motor in the messages is a torque, else 0 [A/(N.m)].
  double current_per_motor_torque{};
  double current_per_effort{ 1.0 };  ///< motor current per effort of the joint [A], [A/(N.m)]
  double time_scale{ 1.0 };          ///< factor for the times in the recording
  /// Largest speeds of the joints, by which RowFilter refuses angles; FASTEST for joints that have none here [rad/s].
  std::vector<double> speeds;
  /// Recording in memory in place of a file: a row of each joint at each time, currents in A.
  std::shared_ptr<const std::vector<std::vector<MotionRow>>> rows;

  static constexpr double FASTEST = 20.0;  ///< speed that no joint exceeds [rad/s]
};

/// Counts of a reading.
struct MotionCount
{
  std::uint64_t rows{};
  std::uint64_t corrupt{};  ///< messages that could not be read, hold no finite angle and current, or cannot be true
  LeftOutRows left_out;     ///< rows that the filter left out; impossible and unreachable rows count as corrupt too
  double duration{};        ///< duration of the recording [s]
  Stamp start{};            ///< stamp of the first row [ns]
  double least_delay{};     ///< least time from the stamp of a message to its recording [s]
  double most_delay{};      ///< largest time from the stamp of a message to its recording [s]
  std::uint64_t refused_temperatures{};  ///< temperatures that are not finite or that no drive can have
  /// Rate of the first joint's angles over the recorded velocities: 1 if both agree, NaN if it is not known.
  double velocity_ratio{ std::numeric_limits<double>::quiet_NaN() };
  std::vector<std::string> remarks;  ///< clauses on repaired or omitted data, without a full stop
  Misfit misfit;                     ///< why nothing can be judged, if that is so

  /// Adds a remark, unless it is empty.
  void remark(const std::string& text)
  {
    if (!text.empty())
    {
      remarks.push_back(text);
    }
  }
};

/// Counts of a reading and of what was made of its rows.
struct MotionFindings : MotionCount
{
  std::uint64_t refused{};  ///< number of rows that are repeated or out of order
  std::uint64_t gaps{};     ///< number of gaps longer than MotionDifferentiator::MAX_GAP
  bool has_load{};          ///< whether the recording gives the load
};

inline bool isCsv(const MotionSource& source)
{
  return source.format == RecordingFormat::TABLE;
}

/// Whether the recording gives the load. Without it the load of the rows is zero. @throws InputError if the file cannot
/// be read.
bool recordsLoad(const MotionSource& source);

/// Gets a row of each joint, all of one time. Returns false if the visitor wants no more rows.
using VisitMotionRows = std::function<bool(const std::vector<MotionRow>& rows)>;

/// Reads a recording row by row, in memory that does not grow with it beyond the bag's own index. `visit` gets a row
/// for each of `names`, all of one time: of the source's joint alone, or of all joints of an arm, for which the source
/// names recording and topics.
///
/// RowFilter checks the rows of all kinds of recordings and leaves out rows that were not measured or cannot be true.
/// Times start at the first row; a loop's rounds follow each other (RowTime). Angles folded into one turn are made
/// continuous (UnfoldedAngle).
/// Messages: header stamps count, or the time of recording where they are zero in all messages. A load counts for rows
/// from its stamp on. Left out and counted: a row that agrees neither with the one before nor with the one after, its
/// angle beyond what any joint can reach in the time or its stamp more than a second off theirs; one with all efforts
/// zero where others have some; one without a stamp where others have one. `misfit` where two sources give the same
/// joint. Rows that hold not all of the joints are left out and counted as corrupt, but where no message holds all of
/// them, each row of the first joint gets the angles and currents of the others from between their neighbours in time.
/// Temperatures of messages are sensor_msgs/Temperature of any topic whose frame_id is the joint; a row has the latest
/// one that is not too old (TemperatureRecord).
/// Table: columns timestamp, actual_q_N, actual_current_N, target_moment_N, as `joint_twin import`, and
/// joint_temperatures_N [degC]; of an arm those of joints 0 to 5, in the order of the names.
/// `progress`: 0 ... 1.
/// @throws InputError if the file, the topic or a joint is not there; it names those that are, or that are missing.
MotionCount readMotion(const MotionSource& source, const std::vector<std::string>& names, const VisitMotionRows& visit,
                       const std::function<void(double)>& progress);
}  // namespace hjt
