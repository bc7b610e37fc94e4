// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "bags/recorded_topic.hpp"
#include "messages/tracker_outputs.hpp"
#include "recordings/arm_assessment.hpp"
#include "recordings/recorded_motion.hpp"
#include "tracking/verdict_watch.hpp"

namespace hjt
{
/// A bag with the topics that the node publishes beside a robot, made offline from its recording. Where that is a bag
/// of ROS 1 too, it holds all of its messages as they are.
class TrackedBag
{
public:
  /// One joint whose comparisons go into the bag.
  struct Joint
  {
    std::string name;             ///< in the messages
    std::string joint_namespace;  ///< its topics lie below, e.g. "/elbow/joint_twin"
    const Parameters& parameters;
  };

  /// A CSV file's times count from SIMULATION_EPOCH.
  /// @throws InputError if a file cannot be opened, or the recording holds a topic of the twin already.
  TrackedBag(const std::string& path, const MotionSource& source, const std::vector<Joint>& joints);

  /// A comparison of a joint, by its place in the list. Takes over what was recorded until the comparison's row.
  void offer(std::size_t joint, const Comparison& comparison, const Tracker& tracker);

  /// The joints are judged too: `trackers` in the order of the list. `arm`: the same recording as a whole, which they
  /// are judged with.
  void judge(const std::vector<Tracker*>& trackers, const ArmAssessment& arm);

  /// After the comparisons of a row: a verdict of each joint about once a second, of the rows so far.
  void offerVerdicts(double time);

  /// Takes over the rest, and the verdicts of all rows. @throws InputError if not all could be written.
  void close();

private:
  static constexpr double VERDICT_RATE = 1.0;  // [Hz]

  void copyUntil(Stamp recorded);
  void judgeNow();

  const std::string source_path_;
  rosbag::Bag source_;  // not open: the recording is no bag
  rosbag::View view_;   // of all of it
  std::optional<rosbag::View::iterator> next_;
  BagWriter writer_;
  Stamp start_{};  // stamp of the first row [ns]
  Stamp delay_{};  // of its recording behind that [ns]
  const std::vector<Joint> joints_;
  std::vector<std::unique_ptr<TrackerOutputs<RecordedTopic>>> outputs_;
  std::vector<std::unique_ptr<VerdictWatch>> verdicts_;
  StampPeriods verdict_periods_{ VERDICT_RATE };
};
}  // namespace hjt
