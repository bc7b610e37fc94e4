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
#include "recordings/recorded_motion.hpp"
#include "recordings/source_watch.hpp"
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
  bool agrees{};  // with a neighbour

  double delay() const { return toSeconds(recorded - stamp); }
};

/// How a topic gives the joints of an arm, by all of its messages.
struct TopicLayout
{
  bool has_stamps{};   ///< a message has a stamp
  bool has_efforts{};  ///< a message has an effort other than zero
  /// Joints whose effort is never a number, while those of other joints are: their current counts as 0.
  std::set<std::string> silent;
  /// Indices of the joints that share a message; a single list: a message holds all of them.
  std::vector<std::vector<std::size_t>> parts;
};

/// Reads as much of the recording as tells.
TopicLayout readLayout(RecordedMessages& recording, const MotionSource& source, const std::vector<std::string>& names);

/// Turns the messages that name the joints of one part into rows, and leaves out what cannot be true. A row waits for
/// the next one: a load with its own stamp can still reach it, and the next one tells whether it can be true.
class MessageRows
{
public:
  using Visit = std::function<bool(const StampedRows& rows)>;

  MessageRows(const MotionSource& source, const std::vector<std::string>& names, const TopicLayout& layout,
              Visit visit);

  /// False: the visitor has had enough.
  bool read(const RecordedMessage& message);
  /// Hands on the row that waits, if it can be true.
  bool flush();

  std::uint64_t corrupt() const { return corrupt_; }
  std::uint64_t withoutTime() const { return without_time_; }
  std::uint64_t withoutEffort() const { return without_effort_; }
  /// Messages in which angle or effort of a joint is no number, by joint.
  const std::map<std::string, std::uint64_t>& missing() const { return missing_; }
  bool hasShortEfforts() const { return has_short_efforts_; }
  std::uint64_t folds() const;
  std::uint64_t refusedTemperatures() const;
  /// Of the rows as they came, true or not.
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
  std::optional<StampedRows> last_;  // unfiltered
  std::uint64_t seen_{};             // the only row has no neighbour to disagree with
  std::uint64_t corrupt_{};
  std::uint64_t without_time_{};
  std::uint64_t without_effort_{};
  std::map<std::string, std::uint64_t> missing_;
  bool has_short_efforts_{};
  SourceWatch sources_;
};
}  // namespace hjt
