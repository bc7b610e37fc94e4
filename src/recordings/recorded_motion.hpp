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
/// Number of a joint that is none of a controller's.
constexpr int NO_COLUMNS = -1;

/// Which joint of which recording.
struct MotionSource
{
  std::string path;                      ///< bag, .db3, .mcap, their directory, or CSV
  RecordingFormat format{};              ///< its
  std::string joint;                     ///< its name in the messages
  int csv_joint{};                       ///< its number in the columns of a CSV file
  std::string topic{ "/joint_states" };  ///< sensor_msgs/JointState
  std::string load_topic;                ///< sensor_msgs/JointState, effort the load [N.m]
  /// Above 0: the effort of NAME_motor in the messages is a torque; current for 1 N.m of it [A].
  double current_per_motor_torque{};
  double current_per_effort{ 1.0 };  ///< of one joint: motor current of 1 of its effort [A], [A/(N.m)]
  double time_scale{ 1.0 };          ///< by which the times in the recording are multiplied
  /// Of the joints, the greatest, beyond which RowFilter takes no angle; of one that has none here FASTEST [rad/s].
  std::vector<double> speeds;
  /// A recording at hand in place of a file: a row of each joint at each time, currents in A.
  std::shared_ptr<const std::vector<std::vector<MotionRow>>> rows;

  static constexpr double FASTEST = 20.0;  ///< faster than any joint [rad/s]
};

/// Counts of a reading.
struct MotionCount
{
  std::uint64_t rows{};
  std::uint64_t corrupt{};  ///< messages that could not be read, hold no finite angle and current, or cannot be true
  LeftOutRows left_out;     ///< by the filter; the impossible and unreachable ones count as corrupt too
  double duration{};        ///< of the recording [s]
  Stamp start{};            ///< stamp of the first row [ns]
  double least_delay{};     ///< messages: of the recording behind the stamps [s]
  double most_delay{};      ///< [s]
  std::uint64_t refused_temperatures{};  ///< not finite, or beyond what a drive can have
  /// Of one joint: change of the angles by the stamps, over the recorded velocities; 1: they agree, NaN: not known.
  double velocity_ratio{ std::numeric_limits<double>::quiet_NaN() };
  std::vector<std::string> remarks;  ///< repaired or omitted data, clauses without a full stop
  Misfit misfit;                     ///< with this nothing can be judged; none: nothing stands against it
};

/// Motion that was read, and the reasons why it cannot be judged.
struct MotionFindings : MotionCount
{
  std::uint64_t refused{};  ///< rows repeated or out of order
  std::uint64_t gaps{};     ///< longer than MotionDifferentiator::MAX_GAP
  bool has_load{};          ///< the recording gives the load
};

inline bool isCsv(const MotionSource& source)
{
  return source.format == RecordingFormat::TABLE;
}

/// True if the recording gives the load; else it is zero in the rows. @throws InputError if the file cannot be read.
bool recordsLoad(const MotionSource& source);

/// Reads a recording row by row, in memory that does not grow with it beyond the bag's own index.
///
/// All kinds go through RowFilter, which leaves out what was not measured or cannot be true.
/// Times start at the first row; a loop's rounds follow each other (RowTime). Angles folded into one turn are made
/// continuous (UnfoldedAngle).
/// Messages: header stamps count, or the time of recording where they are zero in all messages. A load counts for rows
/// from its stamp on. Left out and counted: a row that agrees neither with the one before nor with the one after, its
/// angle beyond what any joint can reach in the time or its stamp more than a second off theirs; one with all efforts
/// zero where others have some; one without a stamp where others have one. `misfit` where two sources give the same
/// joint. Table: columns timestamp, actual_q_N, actual_current_N, target_moment_N, as `joint_twin import`, and
/// joint_temperatures_N [degC]. Temperatures of messages are sensor_msgs/Temperature of any topic whose frame_id is the
/// joint; a row has the latest one that is not too old (TemperatureRecord). `visit` returns false to stop. `progress`:
/// 0 ... 1.
/// @throws InputError if the file, the topic or the joint is not there; it names those that are.
MotionCount readMotion(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                       const std::function<void(double)>& progress);

/// The same for all joints of an arm: `visit` gets a row for each of `names`, all of one time. `source` names recording
/// and topics; its joint counts for nothing. CSV: the columns of joints 0 to 5, in the order of the names. Rows that
/// hold not all of the joints are left out and counted as corrupt, but where no message holds all of them, each row of
/// the first joint gets the angles and currents of the others from between their neighbours in time.
/// @throws InputError likewise; it names the joints that are missing.
MotionCount readArmMotion(const MotionSource& source, const std::vector<std::string>& names,
                          const std::function<bool(const std::vector<MotionRow>&)>& visit,
                          const std::function<void(double)>& progress);
}  // namespace hjt
