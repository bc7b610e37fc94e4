// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/follow.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "bags/bag_file.hpp"
#include "bags/bag_writer.hpp"
#include "messages/tracker_messages.hpp"
#include "output/process_end.hpp"
#include "output/report.hpp"
#include "params/choices.hpp"
#include "recordings/arm_assessment.hpp"
#include "recordings/recorded_motion.hpp"
#include "tracking/telemetry_rows.hpp"
#include "tracking/verdict_watch.hpp"

#include "base/statistics.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
constexpr double VERDICT_RATE = 1.0;  // rate of the verdicts [Hz]

/// Bag with the topics that the node publishes beside a robot, made offline from a recording. If the recording is a bag
/// of ROS 1, this bag also gets all messages of the recording.
class TrackedBag
{
public:
  /// The times of a CSV file are counted from SIMULATION_EPOCH. `recording` must live as long as this object.
  /// @throws InputError if a file cannot be opened, or if the recording has a topic of the twin.
  TrackedBag(const std::string& path, const ArmRecording& recording) : recording_(recording), writer_(path)
  {
    const MotionSource source = recording.source(0);
    if (source.time_scale != 1.0)
    {
      throw InputError("--bag keeps the times of the recording: --time-scale cannot change them");
    }
    const auto take_first = [this](const std::vector<MotionRow>& rows)
    {
      delay_ = std::llround(1e9 * (rows.front().received - rows.front().time));
      return false;
    };
    start_ = recording.readRows(take_first).start + (isCsv(source) ? SIMULATION_EPOCH : 0);
    if (source.format == RecordingFormat::BAG)
    {
      openForReading(source_, source.path);
    }
    for (std::size_t i = 0; i < recording.joints().size(); ++i)
    {
      const std::string joint_namespace = recording.twinNamespace(i);  // the joint's topics lie below it
      if (source.format == RecordingFormat::BAG)
      {
        refuseTopics(source_, source.path, trackerTopics(joint_namespace));
      }
      const BagContext context{ writer_, joint_namespace + "/", delay_ };
      outputs_.push_back(std::make_unique<TrackerOutputs<RecordedTopic>>(context, recording.parameters(i)));
    }
    if (source.format == RecordingFormat::BAG)
    {
      view_.addQuery(source_);
      next_ = view_.begin();
    }
  }

  /// Writes a comparison of the joint with number `joint`, after the messages that were recorded before the comparison.
  void offer(std::size_t joint, const Comparison& comparison, const Tracker& tracker)
  {
    const Stamp stamp = start_ + std::llround(1e9 * comparison.time);
    copyUntil(stamp + delay_);
    outputs_[joint]->offer(stamp, comparison, tracker);
  }

  /// Begins to write verdicts. `trackers` are in the order of the joints. `arm`: assessment of the whole recording.
  void judge(const std::vector<Tracker*>& trackers, const ArmAssessment& arm)
  {
    for (std::size_t i = 0; i < trackers.size(); ++i)
    {
      verdicts_.push_back(std::make_unique<VerdictWatch>(*trackers[i], arm.context(i)));
      verdicts_.back()->setMisfit(arm.judged.misfits[i], true);
    }
  }

  /// The caller calls this function after the comparisons of a row. It writes a verdict of each joint about once a
  /// second. The verdict is based on the rows up to `time` [s].
  void offerVerdicts(double time)
  {
    if (verdict_periods_.begins(start_ + std::llround(1e9 * time)))
    {
      judgeNow();
    }
  }

  /// Copies the remaining messages and writes the final verdicts. @throws InputError if the copy is incomplete.
  void close()
  {
    judgeNow();
    copyUntil(std::numeric_limits<Stamp>::max());
    writer_.close();
  }

private:
  void copyUntil(Stamp recorded)
  {
    try
    {
      while (next_ && *next_ != view_.end() && fromRosTime((*next_)->getTime()) <= recorded)
      {
        writer_.copy(**next_);
        ++*next_;
      }
    }
    catch (const rosbag::BagException& error)
    {
      throw InputError(recording_.options().recording + " cannot be copied: " + error.what() + "; " + writer_.path() +
                       " is readable and holds all earlier messages");
    }
  }

  void judgeNow()
  {
    std::vector<VerdictWatch*> verdicts;
    for (const auto& verdict : verdicts_)
    {
      verdicts.push_back(verdict.get());
    }
    judgeTogether(verdicts, recording_.parameters(0).comparison.repeat_tolerance);
    for (std::size_t i = 0; i < verdicts_.size(); ++i)
    {
      outputs_[i]->offer(start_ + std::llround(1e9 * verdicts_[i]->lastRow()), verdicts_[i]->now());
    }
  }

  const ArmRecording& recording_;
  rosbag::Bag source_;  // open only if the recording is a bag
  rosbag::View view_;   // all messages of source_
  std::optional<rosbag::View::iterator> next_;
  BagWriter writer_;
  Stamp start_{};  // stamp of the first row
  Stamp delay_{};  // time between the first row's stamp and its recording [ns]
  std::vector<std::unique_ptr<TrackerOutputs<RecordedTopic>>> outputs_;
  std::vector<std::unique_ptr<VerdictWatch>> verdicts_;
  StampPeriods verdict_periods_{ VERDICT_RATE };
};

/// Columns of the CSV file: the fields of Comparison.msg.
const std::vector<Column<Comparison>> COLUMNS{
  { "time", &Comparison::time },
  { "position_measured", [](const Comparison& now) { return now.position.measured; } },
  { "position_predicted", [](const Comparison& now) { return now.position.predicted; } },
  { "position_residual", [](const Comparison& now) { return now.position.residual(); } },
  { "position_band", [](const Comparison& now) { return now.position.band; } },
  { "velocity_measured", [](const Comparison& now) { return now.velocity.measured; } },
  { "velocity_predicted", [](const Comparison& now) { return now.velocity.predicted; } },
  { "velocity_residual", [](const Comparison& now) { return now.velocity.residual(); } },
  { "current_measured", [](const Comparison& now) { return now.current.measured; } },
  { "current_predicted", [](const Comparison& now) { return now.current.predicted; } },
  { "current_residual", [](const Comparison& now) { return now.current.residual(); } },
  { "current_band", [](const Comparison& now) { return now.current.band; } },
  { "residual_torque", &Comparison::residual_torque },
  { "joint_torque", &Comparison::joint_torque },
  { "friction_torque", &Comparison::friction_torque },
  { "load_torque", &Comparison::load_torque },
  { "load_told", &Comparison::load_provided },
  { "temperature", &Comparison::temperature },
  { "temperature_received", &Comparison::temperature_received },
  { "sticking", &Comparison::sticking },
  { "after_gap", &Comparison::after_gap },
  { "outside_band", &Comparison::isOutside }
};

/// Runs the twin of one joint beside the recording.
class Follower
{
public:
  /// `bag` gets the comparisons of the joint with this `number`. Null: no bag is written.
  Follower(const ArmRecording& recording, const FollowOptions& options, TrackedBag* bag, std::size_t number)
    : recording_(recording)
    , options_(options)
    , has_arm_load_(recording.isArm() && !recording.usesRecordedLoad())
    , bag_(bag)
    , number_(number)
    , tracker_(recording.parameters(number), options.mode, surfaceSource(options.watch))
  {
    if (!options.out.empty())
    {
      csv_.emplace(path(), COLUMNS);
    }
  }

  void add(const ArmJointRow& joint)
  {
    load_error_.add(joint.row.load + joint.motor_part - joint.recorded_load);
    if (recording_.isArm() || recording_.hasRecordedLoad())
    {
      tracker_.pushLoad(joint.row.time, joint.row.load);
    }
    timing_.add(joint.row.time, joint.row.received);
    if (recording_.isArm())
    {
      take(tracker_.compare(joint.row), joint.motor_part);
      return;
    }
    tracker_.push(joint.row);
    takeAll(false);
  }

  FollowedJoint finish()
  {
    takeAll(true);
    if (csv_)
    {
      csv_->close();
    }
    return { recording_.joints()[number_].short_name,
             tracker_.counters(),
             timing_.report(),
             tracker_.lag(),
             current_.value(),
             residual_.value(),
             velocity_.value(),
             position_.value(),
             has_arm_load_ && recording_.hasRecordedLoad() ? std::make_optional(load_error_.value()) : std::nullopt };
  }

  Tracker& tracker() { return tracker_; }

private:
  std::string path() const
  {
    const std::filesystem::path out = options_.out;
    const std::string path =
        recording_.isArm() ? (out / (recording_.joints()[number_].short_name + ".csv")).string() : options_.out;
    requireWritable(path, options_.force, options_.recording);
    return path;
  }

  void takeAll(bool at_end)
  {
    while (const std::optional<Comparison> now = tracker_.pop(at_end))
    {
      take(*now, 0.0);
    }
  }

  /// `motor_part`: torque of the motor's inertia [N.m]. A controller counts it as load of the joint, but the load that
  /// is computed from the arm lacks it.
  void take(Comparison now, double motor_part)
  {
    if (bag_ != nullptr)
    {
      bag_->offer(number_, now, tracker_);
    }
    // The column `load_torque` holds the load as a controller counts it, with a part of the motor's inertia.
    now.load_torque += has_arm_load_ ? motor_part : 0.0;
    current_.add(now.current.measured);
    residual_.add(now.current.residual());
    velocity_.add(now.velocity.residual());
    position_.add(now.position.residual());
    options_.take(number_, now);
    if (csv_)
    {
      csv_->write(now);
    }
  }

  const ArmRecording& recording_;
  const FollowOptions& options_;
  const bool has_arm_load_;
  TrackedBag* bag_;
  std::size_t number_;  // number of the joint
  Tracker tracker_;
  std::optional<TableFile<Comparison>> csv_;
  StreamTiming timing_;
  Rms current_;
  Rms residual_;
  Rms velocity_;
  Rms position_;
  Rms load_error_;
};

/// Estimates the temperature from the common factor of the joints' friction, and sets that of the twins once a second.
class CommonTemperature
{
public:
  CommonTemperature(const std::vector<Tracker*>& trackers, double tolerance) : tolerance_(tolerance)
  {
    for (Tracker* tracker : trackers)
    {
      joints_.push_back(std::make_unique<VerdictWatch>(*tracker, JointContext()));
      all_.push_back(joints_.back().get());
    }
  }

  void look(double time)
  {
    if (all_.size() < MIN_WITNESSES || !periods_.begins(std::llround(1e9 * time)))
    {
      return;
    }
    const ArmFriction found = commonFriction(all_, tolerance_);
    for (VerdictWatch* joint : all_)
    {
      joint->predictAt(found);
    }
  }

private:
  std::vector<std::unique_ptr<VerdictWatch>> joints_;
  std::vector<VerdictWatch*> all_;
  const double tolerance_;
  StampPeriods periods_{ VERDICT_RATE };
};

/// Makes the bag that options.bag names; null if it names none.
std::unique_ptr<TrackedBag> bagOf(const ArmRecording& recording, const FollowOptions& options)
{
  if (options.bag.empty())
  {
    return nullptr;
  }
  if (!recording.isFile())
  {
    throw InputError("bag = '" + options.bag + "' needs a recording in a file, whose times the bag keeps");
  }
  return std::make_unique<TrackedBag>(options.bag, recording);
}

/// Judges the recording as `compare` does. A load that the currents show becomes the recording's load.
ArmAssessment assessFor(ArmRecording& recording, const FollowOptions& options)
{
  RecordingFit fit(recording.parameters());
  ArmAssessment arm = assess(recording, {}, fit);
  if (!arm.assumed.isConfigured())
  {
    options.watch.notice(arm.assumed.text());
  }
  return arm;
}

void noticeOfUnusedLoad(const ArmRecording& recording, const FollowOptions& options)
{
  const MotionSource source = recording.source(0);
  if (!recording.isArm() && recording.hasRecordedLoad() && recording.parameters(0).telemetry.load == LoadSource::MODEL)
  {
    const std::string load = !recording.isFile() ? "load" : isCsv(source) ? "target_moment" : source.load_topic;
    options.watch.notice("the recording holds a load (" + load +
                         "), but telemetry.load = model ignores it. For a controller's rigid-body torque give "
                         "--config recorded_load.yaml after the joint's own file");
  }
}

const std::vector<Column<FollowedJoint>> JOINT_COLUMNS{
  { "joint", &FollowedJoint::name, "joint" },
  { "rows", [](const FollowedJoint& joint) { return joint.counters.compared; }, "rows" },
  { "current_rms", &FollowedJoint::current_rms, "current, rms [A]" },
  { "current_residual_rms", &FollowedJoint::current_residual_rms, "less predicted [A]" },
  { "outside", [](const FollowedJoint& joint) { return joint.counters.outside; }, "rows outside" },
  { "load_difference_rms", &FollowedJoint::load_error, "load less recorded [N.m]" }
};

Report reportOfArm(const Followed& followed)
{
  const MotionFindings& found = followed.found;
  return { { { "rows", "rows", found.rows },
             { "duration", "duration", found.duration, "s" },
             { "unreadable", "messages unreadable or incomplete", found.corrupt },
             { "refused", "rows repeated, out of order or not finite", found.refused },
             { "gaps", "gaps that divide the recording", found.gaps },
             { "temperatures_refused", "temperatures refused: not finite, impossible values",
               found.refused_temperatures },
             { "load", "load", followed.load } },
           { { "joints", Table(JOINT_COLUMNS, followed.joints) } } };
}

Report reportOfJoint(const MotionFindings& found, const FollowedJoint& joint)
{
  return {
    { { "rows", "rows", found.rows },
      { "duration", "duration", found.duration, "s" },
      { "unreadable", "messages unreadable", found.corrupt },
      { "refused", "rows refused: repeated, out of order, impossible values", joint.counters.refused },
      { "missing", "rows missing, at a period of " + shortNumber(joint.timing.period) + " s", joint.timing.missing },
      { "period", "", joint.timing.period },
      { "gaps", "gaps that divide the recording", joint.counters.gaps },
      { "reception_offset", "reception minus stamp", joint.timing.offset, "s" },
      { "reception_jitter", "jitter of the reception, 95 %", joint.timing.jitter, "s" },
      { "lag", "", joint.lag },
      { "", "delay of the measurement", joint.lag ? Json(*joint.lag) : "unknown", joint.lag ? "s" : "" },
      { "temperatures_refused", "temperatures refused: not finite, impossible values", found.refused_temperatures },
      { "without_load", "rows without a received load", joint.counters.without_load },
      { "current_residual_rms", "measured less predicted current, rms", joint.current_residual_rms, "A" },
      { "velocity_residual_rms", "measured less predicted velocity, rms", joint.velocity_residual_rms, "rad/s" },
      { "position_residual_rms", "measured less predicted position, rms", joint.position_residual_rms, "rad" },
      { "outside", "rows outside the band of the current", joint.counters.outside },
      { "solver_failures", "", joint.counters.solver_failures } },
    {}
  };
}
}  // namespace

void addOptions(OptionTable& table, FollowOptions& options)
{
  addRecordingOption(table, options);
  addJointOptions(table, options);
  const auto take = [&options](const std::string& text)
  {
    for (const auto& [name, mode] : choiceNames(InputMode{}))
    {
      options.mode = text == name ? mode : options.mode;
    }
  };
  table.add("--mode", Option::Kind::TEXT, take, "input of the twin: the recorded current, the motion, or both")
      .choice({ "motion", "observer", "torque" })
      .default_text = "motion";
  table
      .add("--out", options.out,
           "file of measured and predicted values of every row; for an arm, a directory with a file for each joint")
      .type("FILE.csv|DIR");
  table
      .add("--bag", options.bag,
           "topics of the node beside a robot, with the forces on every tooth, and all messages of a recorded bag")
      .type("OUT.bag")
      .endsIn({ ".bag" });
}

Followed follow(const FollowOptions& options)
try
{
  ArmRecording recording(options);
  noticeOfUnusedLoad(recording, options);
  if (recording.isArm() && !options.out.empty())
  {
    std::filesystem::create_directories(options.out);
  }
  requireWritable(options.bag, options.force, options.recording);
  const std::unique_ptr<TrackedBag> bag = bagOf(recording, options);
  const std::optional<ArmAssessment> assessed = bag ? std::make_optional(assessFor(recording, options)) : std::nullopt;
  std::vector<std::unique_ptr<Follower>> followers;
  std::vector<Tracker*> trackers;
  for (std::size_t i = 0; i < recording.joints().size(); ++i)
  {
    followers.push_back(std::make_unique<Follower>(recording, options, bag.get(), i));
    trackers.push_back(&followers.back()->tracker());
  }
  if (bag)
  {
    bag->judge(trackers, *assessed);
  }
  CommonTemperature temperature(trackers, recording.parameters(0).comparison.repeat_tolerance);
  RecordingFit fit(recording.parameters());
  Followed followed{ recording.isArm(), options.load, {}, {} };
  followed.found = recording.read(
      [&](const std::vector<ArmJointRow>& rows)
      {
        for (std::size_t i = 0; i < rows.size(); ++i)
        {
          followers[i]->add(rows[i]);
        }
        temperature.look(rows.front().row.time);
        if (bag)
        {
          bag->offerVerdicts(rows.front().row.time);
        }
      },
      fit);
  recording.noticeOf(fit);
  recording.noticeOf(followed.found);
  for (const auto& follower : followers)
  {
    followed.joints.push_back(follower->finish());
  }
  if (bag)
  {
    bag->close();
  }
  return followed;
}
catch (const Stopped&)
{
  return {};
}

Report reportOf(const Followed& followed)
{
  return followed.is_arm ? reportOfArm(followed) : reportOfJoint(followed.found, followed.joints.front());
}
}  // namespace hjt
