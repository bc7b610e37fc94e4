// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/tracker_node.hpp"

#include <cmath>
#include <cstdlib>

#include <ros/console.h>

#include "gear/ratio.hpp"
#include "ros_io/input_topics.hpp"
#include "ros_io/node_surface_source.hpp"
#include "ros_io/printable.hpp"
#include "ros_io/time.hpp"
#include "ros_io/topics.hpp"

namespace hjt
{
namespace
{
using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

/// Between two warnings of the same kind [s].
constexpr double WARNING_PERIOD = 5.0;
/// Report the telemetry as stopped after this long without a row [s].
constexpr double STOPPED_AFTER = 0.5;
/// Of the names in a message without this joint that are shown [bytes].
constexpr std::size_t MAX_NAMES = 500;
/// Warn when a larger share of the last seconds' rows is outside the band [-].
constexpr double OUTSIDE_WARNING = 0.1;
/// Warn when a stamp differs from the clock by more than this [s].
constexpr double OFFSET_WARNING = 0.5;

/// Whether two rows can be of the same clock: their receptions less stamps [ns].
bool agree(Stamp a, Stamp b)
{
  return std::abs(a - b) <= FAR_STAMP;
}
}  // namespace

TrackerNode::TrackerNode(ros::NodeHandle& node, const Parameters& parameters)
  : names_(parameters.joint.name)
  , parameters_(parameters)
  // Built before the first row is read, so that the same rows give the same numbers.
  , tracker_(parameters, parameters.input.mode, nodeSurfaceSource(false))
  , life_(node, parameters)
  , comparison_(makeMessage<harmonic_joint_twin::Comparison>(parameters))
  , indicators_(makeIndicators(parameters))
  , assessment_(makeAssessment(parameters))
  , indicators_period_(toStampLength(1.0 / parameters.publish.indicators_rate))
  , comparison_publisher_(node.advertise<harmonic_joint_twin::Comparison>(topics::COMPARISON, InputTopics::QUEUE_SIZE))
  , indicators_publisher_(node.advertise<harmonic_joint_twin::Indicators>(topics::INDICATORS, 10))
  , assessment_publisher_(node.advertise<harmonic_joint_twin::Assessment>(topics::ASSESSMENT, 10))
  , tasks_(parameters.joint.hardware_id)
  , reset_service_(node.advertiseService("reset", &TrackerNode::reset, this))
{
  tasks_.add(
      "Input", [this] { return judgeTelemetry(); }, [this](auto& status) { reportTelemetry(status); });
  tasks_.add(
      "Drive", [this] { return judgeComparison(); }, [this](auto& status) { reportComparison(status); });
  tasks_.add(
      "Health", [this] { return judgeHealth(); }, [this](auto& status) { reportHealth(status); });
  timer_ = node.createWallTimer(ros::WallDuration(DiagnosticTasks::LOOK_PERIOD),
                                [this](const ros::WallTimerEvent&) { look(); });
  const InputTopics inputs{ node, too_large_ };
  telemetry_subscriber_ = inputs.subscribe<sensor_msgs::JointState>(
      topics::MEASURED, [this](const JointStateEvent& event) { receiveTelemetry(event); });
  load_subscriber_ = inputs.subscribe<sensor_msgs::JointState>(
      topics::LOAD, [this](const JointStateEvent& event) { receiveLoad(event); });
  load_torque_subscriber_ =
      inputs.subscribe<std_msgs::Float64>(topics::LOAD_TORQUE, [this](const auto& event) { receiveLoadTorque(event); });
}

void TrackerNode::receiveTelemetry(const JointStateEvent& event)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const sensor_msgs::JointState& message = *event.getMessage();
  MotionRow row;
  switch (readTelemetry(message, names_, row))
  {
    case TelemetryStatus::FOUND:
      break;
    case TelemetryStatus::UNKNOWN_JOINT:
      ++refusals_.unknown_joint;
      found_names_.clear();
      for (const std::string& name : message.name)
      {
        found_names_ += (found_names_.empty() ? "" : ", ") + name;
      }
      found_names_ = printable(found_names_, MAX_NAMES);
      ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD, "No " << names_.joint << " on " << telemetry_subscriber_.getTopic()
                                                     << ", which names " << found_names_);
      return;
    case TelemetryStatus::INCOMPLETE:
      ++refusals_.incomplete;
      ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD, "No position or no effort (motor current) of "
                                                   << names_.joint << " on " << telemetry_subscriber_.getTopic());
      return;
    case TelemetryStatus::NOT_FINITE:
      ++refusals_.not_finite;
      return;
  }
  const Stamp stamp = stampOr(message.header.stamp, event.getReceiptTime());
  last_received_ = fromRosTime(event.getReceiptTime());
  if (!start(stamp))
  {
    ++refusals_.far_stamp;
    return;
  }
  row.time = secondsFromStart(stamp);
  row.received = secondsFromStart(last_received_);
  tracker_.push(row);
  publish();
}

/// Sets the tracker's zero with the first row. False: the stamp is far from where those of the rows before lead to; if
/// the next row agrees with this one, the clock of the robot or this machine's was set, and everything restarts.
bool TrackerNode::start(Stamp stamp)
{
  const Stamp offset = last_received_ - stamp;
  const bool moved = start_ && !agree(offset, offset_);
  if (moved && !(refused_offset_ && agree(offset, *refused_offset_)))
  {
    refused_offset_ = offset;
    return false;
  }
  refused_offset_.reset();
  offset_ = offset;
  if (moved)
  {
    tracker_.reset();
    ++clock_changes_;
    start_.reset();
  }
  if (!start_)
  {
    start_ = stamp;
    for (const LoadAt& load : early_loads_)
    {
      passLoad(load);
    }
    early_loads_.clear();
  }
  return true;
}

void TrackerNode::receiveLoad(const JointStateEvent& event)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const sensor_msgs::JointState& message = *event.getMessage();
  double torque = 0.0;
  if (readLoadTorque(message, names_, torque) != EffortStatus::FOUND || !std::isfinite(torque))
  {
    ++refusals_.load;
    return;
  }
  const ros::Time& stamp = message.header.stamp;
  pushLoad({ stamp.isZero() ? std::nullopt : std::make_optional(fromRosTime(stamp)),
             fromRosTime(event.getReceiptTime()), torque });
}

void TrackerNode::receiveLoadTorque(const ros::MessageEvent<const std_msgs::Float64>& event)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const double torque = event.getMessage()->data;
  if (!std::isfinite(torque))
  {
    ++refusals_.load;
    return;
  }
  pushLoad({ std::nullopt, fromRosTime(event.getReceiptTime()), torque });
}

void TrackerNode::pushLoad(const LoadAt& load)
{
  if (start_)
  {
    passLoad(load);
    return;
  }
  early_loads_.push_back(load);
  if (early_loads_.size() > Tracker::LOADS)
  {
    early_loads_.pop_front();
  }
}

/// Once there is a zero: a load by another clock than the rows is refused. Received without a stamp, it is valid from
/// the instant on that the rows' clock shows then.
void TrackerNode::passLoad(const LoadAt& load)
{
  const Stamp stamp = load.stamp.value_or(load.received - offset_);
  if (!agree(load.received - stamp, offset_))
  {
    ++refusals_.load;
    return;
  }
  last_load_stamp_ = stamp;
  tracker_.pushLoad(secondsFromStart(stamp), load.torque);
}

void TrackerNode::publish()
{
  while (const std::optional<Comparison> comparison = tracker_.pop())
  {
    const Stamp stamp = *start_ + std::llround(1e9 * comparison->time);
    fillComparison(stamp, *comparison, comparison_);
    comparison_publisher_.publish(comparison_);
    life_.offer(stamp, nominalRatio(parameters_.gear) * comparison->velocity.measured, comparison->joint_torque,
                parameters_.input.temperature);
    const std::int64_t due = stamp / indicators_period_;
    if (due != indicators_due_)
    {
      indicators_due_ = due;
      fillIndicators(stamp, tracker_.signalIndicators(), indicators_);
      fillAssessment(stamp, tracker_.assessment(), assessment_);
      indicators_publisher_.publish(indicators_);
      assessment_publisher_.publish(assessment_);
    }
  }
}

bool TrackerNode::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  tracker_.reset();
  response.success = true;
  response.message = "the twin restarts with the next row";
  return true;
}

void TrackerNode::look()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::WallTime now = ros::WallTime::now();
  const StreamTimingReport timing = tracker_.timing();
  const TrackerCounters counters = tracker_.counters();
  recent_refusals_.update(refusals_.unknown_joint + refusals_.incomplete + refusals_.not_finite + refusals_.load +
                              refusals_.far_stamp + too_large_,
                          now);
  recent_disorder_.update(timing.repeated + timing.backward, now);
  recent_missing_.update(timing.missing, now);
  recent_restarts_.update(counters.restarts + clock_changes_, now);
  recent_failures_.update(counters.solver_failures, now);
  tasks_.look();
}

bool TrackerNode::hasStopped() const
{
  return toSeconds(fromRosTime(ros::Time::now()) - last_received_) > STOPPED_AFTER;
}

DiagnosticVerdict TrackerNode::judgeTelemetry() const
{
  const StreamTimingReport timing = tracker_.timing();
  const bool refused = recent_refusals_.areRecent();
  if (timing.rows == 0)
  {
    return { DiagnosticStatus::WARN, refused ? "No usable row of " + names_.joint + " yet" :
                                               "No telemetry yet on " + telemetry_subscriber_.getTopic() };
  }
  if (hasStopped())
  {
    return { DiagnosticStatus::WARN, "The telemetry has stopped" };
  }
  if (recent_restarts_.areRecent())
  {
    return { DiagnosticStatus::WARN, "Stamps jumped back: restarted" };
  }
  if (refused)
  {
    return { DiagnosticStatus::WARN,
             "Messages refused: not for this joint, incomplete, not finite, too large, or stamped far off" };
  }
  if (recent_disorder_.areRecent())
  {
    return { DiagnosticStatus::WARN, "Stamps repeat or go back: those rows are left out" };
  }
  if (recent_missing_.areRecent())
  {
    return { DiagnosticStatus::WARN, "Rows are missing" };
  }
  if (std::abs(timing.offset) > OFFSET_WARNING)
  {
    return { DiagnosticStatus::WARN, "Stamps are off this machine's clock" };
  }
  if (parameters_.telemetry.load != LoadSource::MODEL && !last_load_stamp_)
  {
    return { DiagnosticStatus::WARN, "No load received: weight and inertia as configured" };
  }
  return { DiagnosticStatus::OK, "Telemetry arrives" };
}

DiagnosticVerdict TrackerNode::judgeComparison() const
{
  if (recent_failures_.areRecent())
  {
    return { DiagnosticStatus::ERROR, "The solver did not converge: the last good state is held" };
  }
  if (hasStopped())
  {
    return { DiagnosticStatus::STALE, "Nothing to compare with" };
  }
  if (tracker_.outsideShare() > OUTSIDE_WARNING)
  {
    return { DiagnosticStatus::WARN, "The current departs from a healthy joint's" };
  }
  return { DiagnosticStatus::OK, "Within the band of a healthy joint" };
}

DiagnosticVerdict TrackerNode::judgeHealth() const
{
  const Assessment& assessment = tracker_.assessment();
  if (hasStopped())
  {
    return { DiagnosticStatus::STALE, "The telemetry has stopped. Last: " + verdictText(assessment) };
  }
  return { static_cast<std::uint8_t>(assessment.level), verdictText(assessment) };
}

void TrackerNode::reportTelemetry(DiagnosticStatusWrapper& status) const
{
  const StreamTimingReport timing = tracker_.timing();
  const TrackerCounters counters = tracker_.counters();
  status.add("Topic", telemetry_subscriber_.getTopic());
  status.add("Joint", names_.joint);
  status.add("Rows", timing.rows);
  status.add("Period [s]", timing.period);
  status.add("Rows missing", timing.missing);
  status.add("Longest gap [s]", timing.longest_gap);
  status.add("Gaps that cut the stream", counters.gaps);
  status.add("Stamps repeated", timing.repeated);
  status.add("Stamps going back", timing.backward);
  status.add("Restarts", counters.restarts + clock_changes_);
  status.add("Reception less stamp [s]", timing.offset);
  status.add("Jitter of reception, 95 % [s]", timing.jitter);
  status.add("Unknown joint, refused", refusals_.unknown_joint);
  status.add("Names in the last of those", found_names_);
  status.add("Without position or effort, refused", refusals_.incomplete);
  status.add("Not finite, refused", refusals_.not_finite);
  status.add("Too large, refused", too_large_.load());
  status.add("Stamp far from the clock, refused", refusals_.far_stamp);
  status.add("Loads refused", refusals_.load);
  status.add("Rows without a received load", counters.without_load);
  if (last_load_stamp_)
  {
    status.add("Load's stamp before the newest row's reception [s]", toSeconds(last_received_ - *last_load_stamp_));
  }
}

void TrackerNode::reportComparison(DiagnosticStatusWrapper& status) const
{
  const TrackerCounters counters = tracker_.counters();
  const std::optional<double> lag = tracker_.lag();
  status.add("Residual of the current [A]", comparison_.current_residual);
  status.add("Its band [A]", comparison_.current_band);
  status.add("Residual of the position [rad]", comparison_.position_residual);
  status.add("Residual of the velocity [rad/s]", comparison_.velocity_residual);
  status.add("Joint torque net of friction [N.m]", comparison_.joint_torque);
  status.add("Load [N.m]", comparison_.load_torque);
  status.add("Rows compared", counters.compared);
  status.add("Rows outside the band", counters.outside);
  status.add("Share of the last ones outside [-]", tracker_.outsideShare());
  status.add("Steps failed", counters.solver_failures);
  if (lag)
  {
    status.add("Measured after predicted [s]", *lag);
  }
  else
  {
    status.add("Measured after predicted [s]", "unknown");
  }
}

void TrackerNode::reportHealth(DiagnosticStatusWrapper& status) const
{
  addAssessment(tracker_.assessment(), status);
}
}  // namespace hjt
