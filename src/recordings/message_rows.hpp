// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bags/recorded_messages.hpp"
#include "messages/conversions.hpp"
#include "recordings/motion_readers.hpp"
#include "recordings/recorded_motion.hpp"
#include "tracking/drive_temperature.hpp"
#include "tracking/telemetry_rows.hpp"

namespace hjt
{
/// Rows of some joints at one time.
struct StampedRows
{
  std::vector<MotionRow> rows;
  Stamp stamp{};
  Stamp recorded{};
  std::string publisher;
  bool agrees{};  // with the row before or after

  double delay() const { return toSeconds(recorded - stamp); }
};

/// How the messages of a topic hold the joints of an arm.
struct TopicLayout
{
  bool has_stamps{};   ///< at least one message has a stamp
  bool has_efforts{};  ///< at least one message has an effort other than zero
  /// Joints whose effort is never a number, while other joints' efforts are. Their current counts as 0.
  std::set<std::string> silent;
  /// Lists of the joints that share a message, by their numbers. A single list: each message holds all joints.
  std::vector<std::vector<std::size_t>> parts;
};

/// Finds the layout of a topic. It reads only as many messages as are needed.
TopicLayout readLayout(RecordedMessages& recording, const MotionSource& source, const std::vector<std::string>& names);

/// Makes rows of the messages that name the joints of one part, and leaves out rows that cannot be true. A row waits
/// for the next one, which shows whether it can be true; a load with an own stamp can reach the row until then.
class MessageRows
{
public:
  using Visit = std::function<bool(const StampedRows& rows)>;

  MessageRows(const MotionSource& source, const std::vector<std::string>& names, const TopicLayout& layout,
              Visit visit);

  /// Takes a message. Returns false if the visitor has had enough.
  bool read(const RecordedMessage& message);
  /// Gives the row that waits to the visitor, if the row can be true.
  bool flush();

  std::uint64_t corrupt() const { return corrupt_; }
  std::uint64_t withoutTime() const { return without_time_; }
  std::uint64_t withoutEffort() const { return without_effort_; }
  /// Number of messages in which angle or effort of a joint is no number, by joint.
  const std::map<std::string, std::uint64_t>& missing() const { return missing_; }
  bool hasShortEfforts() const { return has_short_efforts_; }
  const std::vector<UnfoldedAngle>& angles() const { return angles_; }
  std::uint64_t refusedTemperatures() const;
  /// Whether several sources give the joints, by all rows.
  const SourceWatch& sources() const { return sources_; }

private:
  bool takeTelemetry(const sensor_msgs::JointState& message, const RecordedMessage& recorded);
  bool readRows(const sensor_msgs::JointState& message, std::vector<MotionRow>& rows);
  bool tellsWhose(const sensor_msgs::JointState& message) const;
  bool agree(const StampedRows& a, const StampedRows& b) const;
  void readLoad(const sensor_msgs::JointState& message, Stamp stamp);

  const MotionSource& source_;
  const TopicLayout& layout_;
  const Visit visit_;
  const std::vector<std::string> joints_;
  std::vector<JointNames> names_;
  std::vector<UnfoldedAngle> angles_;
  std::vector<double> loads_;
  std::vector<TemperatureRecord> temperatures_;
  std::optional<StampedRows> waiting_;
  std::optional<StampedRows> last_;  // last row, whether it can be true or not
  std::uint64_t seen_{};             // number of rows; a single row cannot disagree with another one
  std::uint64_t corrupt_{};
  std::uint64_t without_time_{};
  std::uint64_t without_effort_{};
  std::map<std::string, std::uint64_t> missing_;
  bool has_short_efforts_{};
  SourceWatch sources_;
};
}  // namespace hjt
