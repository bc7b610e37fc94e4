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
struct StampedRows
{
  std::vector<MotionRow> rows;
  Stamp stamp{};
  Stamp recorded{};
  std::string publisher;
  bool agrees{};  // whether the angles are consistent with those of the row before or after

  double delay() const { return toSeconds(recorded - stamp); }
};

/// Contents of the messages of a topic, as far as they concern the joints of an arm.
struct TopicLayout
{
  bool has_stamps{};   ///< whether at least one message has a stamp
  bool has_efforts{};  ///< whether at least one message has an effort other than zero
  /// Joints whose effort is never a number, while efforts of other joints are numbers. Their current counts as 0.
  std::set<std::string> silent;
  /// Groups of joints that share a message, each joint by its number. One group: each message holds all joints.
  std::vector<std::vector<std::size_t>> parts;
};

/// Finds the layout of a topic. The function reads only as many messages as it needs.
TopicLayout readLayout(RecordedMessages& recording, const MotionSource& source, const std::vector<std::string>& names);

/// Makes rows from the messages that name one group of joints, and omits impossible rows. A row waits for the next row,
/// which shows whether the waiting row is possible. A load whose stamp is not later is still added to the waiting row.
class MessageRows
{
public:
  using Visit = std::function<bool(const StampedRows& rows)>;

  MessageRows(const MotionSource& source, const std::vector<std::string>& names, const TopicLayout& layout,
              Visit visit);

  /// Reads a message. Returns false if the visitor wants no more rows.
  bool read(const RecordedMessage& message);
  /// Gives the waiting row to the visitor, unless the row is impossible.
  bool flush();

  std::uint64_t corrupt() const { return corrupt_; }
  std::uint64_t withoutTime() const { return without_time_; }
  std::uint64_t withoutEffort() const { return without_effort_; }
  /// Number of messages in which the angle or effort of a joint is not a number, by the joint's name.
  const std::map<std::string, std::uint64_t>& missing() const { return missing_; }
  bool hasShortEfforts() const { return has_short_efforts_; }
  const std::vector<UnfoldedAngle>& angles() const { return angles_; }
  std::uint64_t refusedTemperatures() const;
  /// Evidence from all rows on whether several sources publish the joints.
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
  std::optional<StampedRows> last_;  // the last row, even if it is impossible
  std::uint64_t seen_{};             // number of rows so far; the first row has no earlier row to disagree with
  std::uint64_t corrupt_{};
  std::uint64_t without_time_{};
  std::uint64_t without_effort_{};
  std::map<std::string, std::uint64_t> missing_;
  bool has_short_efforts_{};
  SourceWatch sources_;
};
}  // namespace hjt
