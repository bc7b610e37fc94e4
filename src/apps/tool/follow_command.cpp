// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/arm_recording.hpp"
#include "apps/common/surface_source.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/output_file.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "output/text_table.hpp"

#include "recordings/tracked_bag.hpp"
#include "tracking/effort.hpp"
#include "tracking/tracker.hpp"

namespace hjt
{
namespace
{
const std::map<std::string, InputMode> MODES{ { "torque", InputMode::TORQUE },
                                              { "motion", InputMode::MOTION },
                                              { "observer", InputMode::OBSERVER } };

struct FollowOptions : ArmOptions
{
  std::string mode;
  std::string out;
  std::string bag;
};

/// As the fields of Comparison.msg.
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

/// Root mean square of what is added.
class Rms
{
public:
  void add(double value)
  {
    squares_ += value * value;
    ++count_;
  }
  double value() const { return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0.0; }

private:
  double squares_{};
  std::uint64_t count_{};
};

struct FollowSummary
{
  MotionCount count;
  TrackerCounters counters;
  StreamTimingReport timing;
  std::optional<double> lag;
  Rms current;
  Rms velocity;
  Rms position;
};

FollowSummary compare(const MotionSource& source, Tracker& tracker, const std::function<void(const Comparison&)>& visit)
{
  const bool has_load = recordsLoad(source);
  Progress progress("reading");
  FollowSummary summary;
  const auto take_all = [&](bool at_end)
  {
    while (const std::optional<Comparison> now = tracker.pop(at_end))
    {
      summary.current.add(now->current.residual());
      summary.velocity.add(now->velocity.residual());
      summary.position.add(now->position.residual());
      visit(*now);
    }
  };
  summary.count = readMotion(
      source,
      [&](const MotionRow& row)
      {
        if (has_load)
        {
          tracker.pushLoad(row.time, row.load);
        }
        tracker.push(row);
        take_all(false);
        return interruptSignal() == 0;
      },
      [&](double done) { progress.update(done); });
  take_all(true);
  summary.counters = tracker.counters();
  summary.timing = tracker.timing();
  summary.lag = tracker.lag();
  return summary;
}

void print(const FollowSummary& summary, bool json)
{
  printReport(
      json, { { "rows", "rows", summary.count.rows },
              { "duration", "duration", summary.count.duration, "s" },
              { "unreadable", "messages unreadable", summary.count.corrupt },
              { "refused", "rows refused: repeated, out of order, impossible values", summary.counters.refused },
              { "missing", "rows missing, at a period of " + shortNumber(summary.timing.period) + " s",
                summary.timing.missing },
              { "period", "", summary.timing.period },
              { "gaps", "gaps that cut the recording", summary.counters.gaps },
              { "reception_offset", "reception minus stamp", summary.timing.offset, "s" },
              { "reception_jitter", "jitter of the reception, 95 %", summary.timing.jitter, "s" },
              { "lag", "", summary.lag },
              { "", "delay of the measurement", summary.lag ? Json(*summary.lag) : "unknown", summary.lag ? "s" : "" },
              { "temperatures_refused", "temperatures refused: not finite, impossible values",
                summary.count.refused_temperatures },
              { "without_load", "rows without a received load", summary.counters.without_load },
              { "current_residual_rms", "measured less predicted current, rms", summary.current.value(), "A" },
              { "velocity_residual_rms", "measured less predicted velocity, rms", summary.velocity.value(), "rad/s" },
              { "position_residual_rms", "measured less predicted position, rms", summary.position.value(), "rad" },
              { "outside", "rows outside the band of the current", summary.counters.outside },
              { "solver_failures", "", summary.counters.solver_failures } });
}

int followJoint(const FollowOptions& options)
{
  const Parameters parameters = loadParameters(options);
  requireWritable(options.out, options.force, options.recording);
  requireWritable(options.bag, options.force, options.recording);
  std::optional<TableFile<Comparison>> csv;
  if (!options.out.empty())
  {
    csv.emplace(options.out, COLUMNS);
  }
  MotionSource source = motionSource(options);
  source.current_per_effort = currentPerEffort(parameters);
  if (parameters.telemetry.load == LoadSource::MODEL && recordsLoad(source))
  {
    std::cerr << "joint_twin: the recording holds a load (" << (isCsv(source) ? "target_moment" : source.load_topic)
              << "), but telemetry.load = model leaves it out; for a controller's rigid-body torque give --config "
                 "recorded_load.yaml after the joint's own file\n";
  }
  Tracker tracker(parameters, MODES.at(options.mode), surfaceSource());
  std::optional<TrackedBag> bag;
  if (!options.bag.empty())
  {
    bag.emplace(options.bag, source,
                std::vector<TrackedBag::Joint>{ { source.joint, options.joint_namespace, parameters } });
    bag->judge({ &tracker }, false);
  }
  const InterruptScope interrupts;
  const FollowSummary summary = compare(source, tracker,
                                        [&](const Comparison& now)
                                        {
                                          if (csv)
                                          {
                                            csv->write(now);
                                          }
                                          if (bag)
                                          {
                                            bag->offer(0, now, tracker);
                                            bag->offerVerdicts(now.time, nullptr);
                                          }
                                        });
  if (csv)
  {
    csv->close();
  }
  if (bag)
  {
    bag->close();
  }
  warnOfStamps(summary.count);
  print(summary, options.json);
  return interruptSignal() == 0 ? EXIT_DONE : EXIT_BY_SIGNAL + interruptSignal();
}

/// One joint of an arm beside its twin.
class ArmFollower
{
public:
  /// `bag`: gets the comparisons as those of joint `number`, if there is one.
  ArmFollower(const Parameters& parameters, const FollowOptions& options, bool uses_recorded, const std::string& out,
              TrackedBag* bag, std::size_t number)
    : has_arm_load_(!uses_recorded)
    , bag_(bag)
    , number_(number)
    , tracker_(parameters, MODES.at(options.mode), surfaceSource())
  {
    if (!out.empty())
    {
      csv_.emplace(out, COLUMNS);
    }
  }

  void add(const ArmJointRow& joint, bool has_recorded_load)
  {
    if (has_arm_load_)
    {
      motor_parts_.push_back({ joint.row.time, joint.motor_part });
      if (has_recorded_load)
      {
        load_error_.add(joint.row.load + joint.motor_part - joint.recorded_load);
      }
    }
    tracker_.pushLoad(joint.row.time, joint.row.load);
    tracker_.push(joint.row);
    take(false);
  }

  void finish()
  {
    take(true);
    if (csv_)
    {
      csv_->close();
    }
  }

  Tracker& tracker() { return tracker_; }
  TrackerCounters counters() const { return tracker_.counters(); }
  const Rms& current() const { return current_; }
  const Rms& residual() const { return residual_; }
  const Rms& loadError() const { return load_error_; }

private:
  void take(bool at_end)
  {
    while (std::optional<Comparison> now = tracker_.pop(at_end))
    {
      if (bag_ != nullptr)
      {
        bag_->offer(number_, *now, tracker_);
      }
      // The column is the torque of a controller, whichever load is taken.
      while (!motor_parts_.empty() && motor_parts_.front().time < now->time)
      {
        motor_parts_.pop_front();
      }
      if (!motor_parts_.empty())
      {
        now->load_torque += motor_parts_.front().torque;
      }
      current_.add(now->current.measured);
      residual_.add(now->current.residual());
      if (csv_)
      {
        csv_->write(*now);
      }
    }
  }

  struct MotorPart
  {
    double time;
    double torque;
  };

  bool has_arm_load_;
  TrackedBag* bag_;
  std::size_t number_;  // of the joint in the bag
  Tracker tracker_;
  std::optional<TableFile<Comparison>> csv_;
  std::deque<MotorPart> motor_parts_;  // of rows whose comparison is to come
  Rms current_;
  Rms residual_;
  Rms load_error_;
};

struct ArmLine
{
  std::string joint;
  const ArmFollower* follower;
  bool has_load_error;
};

const std::vector<Column<ArmLine>> ARM_COLUMNS{
  { "joint", &ArmLine::joint, "joint" },
  { "rows", [](const ArmLine& line) { return line.follower->counters().compared; }, "rows" },
  { "current_rms", [](const ArmLine& line) { return line.follower->current().value(); }, "current, rms [A]" },
  { "current_residual_rms", [](const ArmLine& line) { return line.follower->residual().value(); },
    "less predicted [A]" },
  { "outside", [](const ArmLine& line) { return line.follower->counters().outside; }, "rows outside" },
  { "load_difference_rms",
    [](const ArmLine& line) { return line.has_load_error ? Json(line.follower->loadError().value()) : Json(); },
    "load less recorded [N.m]" }
};

/// Topics as those of arm.launch. Null: no `--bag`.
std::unique_ptr<TrackedBag> armBag(const ArmRecording& recording, const FollowOptions& options)
{
  if (options.bag.empty())
  {
    return nullptr;
  }
  std::vector<TrackedBag::Joint> joints;
  for (std::size_t i = 0; i < recording.joints().size(); ++i)
  {
    const ArmJoint& joint = recording.joints()[i];
    joints.push_back({ joint.name, "/" + joint.short_name + options.joint_namespace, recording.parameters(i) });
  }
  return std::make_unique<TrackedBag>(options.bag, recording.source(0), joints);
}

int followArm(const FollowOptions& options)
{
  const ArmRecording recording(options);
  if (!options.out.empty())
  {
    std::filesystem::create_directories(options.out);
  }
  requireWritable(options.bag, options.force, options.recording);
  const std::unique_ptr<TrackedBag> bag = armBag(recording, options);
  std::vector<std::unique_ptr<ArmFollower>> followers;
  std::vector<ArmLine> lines;
  const bool has_load_error = recording.hasRecordedLoad() && !recording.usesRecordedLoad();
  for (std::size_t i = 0; i < recording.joints().size(); ++i)
  {
    const std::string& name = recording.joints()[i].short_name;
    const std::string out = options.out.empty() ? "" : (std::filesystem::path(options.out) / (name + ".csv")).string();
    if (!out.empty())
    {
      requireWritable(out, options.force, options.recording);
    }
    followers.push_back(std::make_unique<ArmFollower>(recording.parameters(i), options, recording.usesRecordedLoad(),
                                                      out, bag.get(), i));
    lines.push_back({ name, followers.back().get(), has_load_error });
  }
  std::vector<Tracker*> trackers;
  for (const std::unique_ptr<ArmFollower>& follower : followers)
  {
    trackers.push_back(&follower->tracker());
  }
  if (bag)
  {
    bag->judge(trackers, !options.identified.empty());
  }
  ArmFrictionWatch friction(trackers, recording.parameters(0).comparison.repeat_tolerance);
  RecordingFit fit(recording.parameters());
  const InterruptScope interrupts;
  const MotionFindings found = recording.read(
      [&](const std::vector<ArmJointRow>& rows)
      {
        for (std::size_t i = 0; i < rows.size(); ++i)
        {
          followers[i]->add(rows[i], recording.hasRecordedLoad());
        }
        friction.look(rows.front().row.time);
        if (bag)
        {
          bag->offerVerdicts(rows.front().row.time, &fit);
        }
      },
      fit);
  recording.warnOf(fit);
  for (const std::unique_ptr<ArmFollower>& follower : followers)
  {
    follower->finish();
  }
  if (bag)
  {
    bag->close();
  }
  warnOfStamps(found);
  printReport(
      options.json,
      { { "rows", "rows", found.rows },
        { "duration", "duration", found.duration, "s" },
        { "unreadable", "messages unreadable or incomplete", found.corrupt },
        { "refused", "rows repeated, out of order or not finite", found.refused },
        { "gaps", "gaps that cut the recording", found.gaps },
        { "temperatures_refused", "temperatures refused: not finite, impossible values", found.refused_temperatures },
        { "load", "load", options.load } },
      { { "joints", Table(ARM_COLUMNS, lines) } });
  return interruptSignal() == 0 ? EXIT_DONE : EXIT_BY_SIGNAL + interruptSignal();
}

int follow(const FollowOptions& options)
{
  return options.arm.empty() ? followJoint(options) : followArm(options);
}

void declare(Command& command, FollowOptions& options)
{
  addArmOptions(command, options);
  options.mode = "motion";
  command.add("--mode", options.mode, "input of the twin: the recorded current, motion, or both")
      .choice({ "motion", "observer", "torque" });
  command.add("--out", options.out, "every row, measured and predicted; of an arm a directory, a file for each joint")
      .type("FILE.csv|DIR");
  command
      .add("--bag", options.bag,
           "the topics of the node beside a robot, with the forces on every tooth; of a bag its own messages too")
      .type("OUT.bag")
      .bag();
}

const Subcommand FOLLOW{ Subject::RECORDING, "follow",
                         "runs a healthy joint on a recording: measured and predicted motion and current", declare,
                         follow };
}  // namespace
}  // namespace hjt
