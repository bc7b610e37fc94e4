// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/joint_tracker.hpp"

#include <algorithm>

#include <ros/console.h>

#include "gear/ratio.hpp"
#include "messages/topics.hpp"
#include "ros_io/node_environment.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
namespace
{
using diagnostic_msgs::DiagnosticStatus;

/// Time without a row after which the telemetry counts as stopped [s].
constexpr double STOPPED_AFTER = 0.5;
/// Largest difference of a stamp from the clock without a warning [s].
constexpr double OFFSET_WARNING = 0.5;

/// Text without the full stop at its end, because texts of diagnostics end without full stop.
std::string withoutStop(std::string sentences)
{
  if (!sentences.empty() && sentences.back() == '.')
  {
    sentences.pop_back();
  }
  return sentences;
}

const char* levelName(std::uint8_t level)
{
  return level == DiagnosticStatus::STALE ? "STALE" : levelName(static_cast<HealthLevel>(level));
}

std::string notJudged(const Misfit& misfit)
{
  return "Not judged: " + misfit.clause;
}
}  // namespace

JointTracker::JointTracker(ros::NodeHandle& node, const Parameters& parameters, const SoundJoint& sound,
                           bool is_identified, TelemetryStream& stream, std::mutex& mutex)
  : stream_(stream)
  , mutex_(mutex)
  , name_(node.getNamespace().substr(1))
  , names_(parameters.joint.name)
  , takes_arm_load_(parameters.telemetry.load == LoadSource::ARM)
  , thermal_model_(parameters.thermal.model)
  , ratio_(nominalRatio(parameters.gear))
  , greatest_speed_(hjt::greatestSpeed(parameters))
  , current_per_effort_(hjt::currentPerEffort(parameters))
  // The response surface is ready before the first row, so that equal rows give equal numbers.
  , tracker_(parameters, parameters.input.mode, nodeSurfaceSource(false))
  , verdict_(tracker_, { sound.own, is_identified })
  , outputs_(node, parameters)
  , life_(node, parameters)
  , tasks_(name_, parameters.joint.hardware_id)
  , reset_service_(node.advertiseService("reset", &JointTracker::reset, this))
{
  tracker_.setReference(sound.baseline);
  tasks_.add("Input", this, &JointTracker::judgeTelemetry, &JointTracker::reportTelemetry);
  tasks_.add("Drive", this, &JointTracker::judgeComparison, &JointTracker::reportComparison);
  tasks_.add("Health", this, &JointTracker::judgeHealth, &JointTracker::reportHealth);
  load_torque_subscriber_ = InputTopics{ node, stream_.too_large }.subscribe<std_msgs::Float64>(
      topics::LOAD_TORQUE, [this](const auto& event) { receiveLoadTorque(event); });
}

TelemetryStatus JointTracker::read(const sensor_msgs::JointState& message, MotionRow& row)
{
  const TelemetryStatus status = readTelemetry(message, names_, row);
  switch (status)
  {
    case TelemetryStatus::FOUND:
      row.current *= current_per_effort_;
      without_effort_ = 0;
      has_effort_ = true;
      break;
    case TelemetryStatus::WITHOUT_EFFORT:
      if (takesArmLoad() && !has_effort_ && ++without_effort_ > SILENT)
      {
        row.current = 0.0;
        return TelemetryStatus::FOUND;
      }
      ++refusals_.not_finite;
      break;
    case TelemetryStatus::UNKNOWN_JOINT:
      ++refusals_.unknown_joint;
      break;
    case TelemetryStatus::INCOMPLETE:
      ++refusals_.incomplete;
      ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD, "There is no position or no effort (motor current) of "
                                                   << names_.joint << " on " << stream_.topic);
      break;
    case TelemetryStatus::NOT_FINITE:
      ++refusals_.not_finite;
      break;
  }
  return status;
}

void JointTracker::start(bool reset)
{
  if (reset)
  {
    forgetAll();
  }
  for (const LoadAt& load : early_loads_)
  {
    passLoad(load);
  }
  early_loads_.clear();
  if (early_temperature_)
  {
    passTemperature(*early_temperature_);
    early_temperature_.reset();
  }
}

/// Forgets all rows and results, including the verdict.
void JointTracker::forgetAll()
{
  tracker_.reset();
  verdict_.judge();
}

void JointTracker::push(const MotionRow& row)
{
  tracker_.push(row);
  while (const std::optional<Comparison> comparison = tracker_.pop())
  {
    publish(*comparison);
  }
}

void JointTracker::compare(const MotionSample& row)
{
  publish(tracker_.compare(row));
}

void JointTracker::setMisfit(const Misfit& misfit, bool settled)
{
  verdict_.setMisfit(misfit, settled);
  tracker_.setFits(!misfit.exists());
}

void JointTracker::receiveLoad(const sensor_msgs::JointState& message, Stamp received)
{
  double torque = 0.0;
  if (readLoadTorque(message, names_, torque) != EffortStatus::FOUND || !std::isfinite(torque))
  {
    ++refusals_.load;
    return;
  }
  const ros::Time& stamp = message.header.stamp;
  takeLoad({ stamp.isZero() ? std::nullopt : std::make_optional(fromRosTime(stamp)), received, torque });
}

void JointTracker::receiveLoadTorque(const ros::MessageEvent<const std_msgs::Float64>& event)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const double torque = event.getMessage()->data;
  if (!std::isfinite(torque))
  {
    ++refusals_.load;
    return;
  }
  takeLoad({ std::nullopt, fromRosTime(event.getReceiptTime()), torque });
}

void JointTracker::takeLoad(const LoadAt& load)
{
  if (stream_.clock.hasStarted())
  {
    passLoad(load);
    return;
  }
  early_loads_.push_back(load);
  if (early_loads_.size() > HeldValues::ROOM)
  {
    early_loads_.pop_front();
  }
}

/// Passes a load to the tracker, after the zero of time is set. Refuses a load with a stamp of another clock than the
/// rows'. A load without a stamp is valid from the present time of the rows' clock.
void JointTracker::passLoad(const LoadAt& load)
{
  const Stamp stamp = load.stamp.value_or(stream_.clock.at(load.received));
  if (takesArmLoad() || !stream_.clock.isOf(stamp, load.received))
  {
    ++refusals_.load;
    return;
  }
  last_load_stamp_ = stamp;
  tracker_.pushLoad(stream_.clock.seconds(stamp), load.torque);
}

void JointTracker::receiveTemperature(const sensor_msgs::Temperature& message, Stamp received)
{
  const ros::Time& stamp = message.header.stamp;
  const TemperatureAt temperature{ stamp.isZero() ? std::nullopt : std::make_optional(fromRosTime(stamp)), received,
                                   message.temperature };
  if (!TemperatureRecord::isPossible(message.temperature))
  {
    ++refusals_.temperature;
  }
  else if (stream_.clock.hasStarted())
  {
    passTemperature(temperature);
  }
  else
  {
    early_temperature_ = temperature;
  }
}

/// Passes a temperature to the tracker, as passLoad passes a load.
void JointTracker::passTemperature(const TemperatureAt& temperature)
{
  const Stamp stamp = temperature.stamp.value_or(stream_.clock.at(temperature.received));
  if (stream_.clock.isOf(stamp, temperature.received))
  {
    tracker_.pushTemperature(stream_.clock.seconds(stamp), temperature.temperature);
  }
  else
  {
    ++refusals_.temperature;
  }
}

void JointTracker::publish(const Comparison& comparison)
{
  const Stamp stamp = stream_.clock.stamp(comparison.time);
  outputs_.offer(stamp, comparison, tracker_);
  life_.offer(stamp, ratio_ * comparison.velocity.measured, comparison.joint_torque, comparison.temperature,
              tracker_.assessment());
  comparison_ = comparison;
}

bool JointTracker::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  forgetAll();
  response.success = true;
  response.message = "the twin will restart with the next row";
  return true;
}

void JointTracker::look(const ros::WallTime& now)
{
  const StreamTimingReport timing = stream_.timing.report();
  const TrackerCounters counters = tracker_.counters();
  recent_refusals_.update(refusals_.incomplete + refusals_.not_finite + refusals_.load + refusals_.temperature +
                              stream_.far_stamps + stream_.too_large + stream_.without_effort +
                              stream_.left_out.impossible + stream_.left_out.unreachable,
                          now);
  recent_disorder_.update(timing.repeated + timing.backward, now);
  recent_missing_.update(timing.missing, now);
  recent_restarts_.update(counters.restarts + stream_.clock_changes, now);
  recent_failures_.update(counters.solver_failures, now);
  publishVerdict();
  tasks_.look();
  logState();
}

/// Logs the worst level of comparison and health when telemetry arrives first, and each change of this level.
void JointTracker::logState()
{
  if (tracker_.counters().compared == 0)
  {
    return;
  }
  const DiagnosticVerdict drive = judgeComparison();
  const DiagnosticVerdict health = judgeHealth();
  const std::uint8_t level = std::max(drive.level, health.level);
  if (level == logged_level_)
  {
    return;
  }
  logged_level_ = level;
  ROS_LOG_STREAM(level == DiagnosticStatus::OK ? ros::console::levels::Info : ros::console::levels::Warn,
                 ROSCONSOLE_DEFAULT_NAME,
                 name_ << ": " << levelName(level) << ". " << drive.text << ". "
                       << (hasStopped() ? verdictText(tracker_.assessment()) : health.text));
}

bool JointTracker::hasStopped() const
{
  return toSeconds(fromRosTime(ros::Time::now()) - stream_.last_received) > STOPPED_AFTER;
}

/// Verdict on the rows. If the solver has failed recently, the level is ERROR and the failure is the reason.
Verdict JointTracker::verdictNow() const
{
  Verdict verdict = verdict_.now();
  if (recent_failures_.areRecent())
  {
    verdict.dismiss({ Reason::SOLVER_FAILED, "" });
    verdict.level = VerdictLevel::ERROR;
  }
  return verdict;
}

/// Publishes the verdict if it differs from the last one or covers more rows. The last verdict stays latched.
void JointTracker::publishVerdict()
{
  if (tracker_.counters().compared == 0)
  {
    return;
  }
  const Verdict verdict = verdictNow();
  const std::pair<VerdictLevel, Reason> state{ verdict.level, verdict.reason };
  if (published_ == state && published_row_ == verdict_.lastRow())
  {
    return;
  }
  published_ = state;
  published_row_ = verdict_.lastRow();
  outputs_.offer(stream_.clock.stamp(published_row_), verdict);
}

DiagnosticVerdict JointTracker::judgeTelemetry() const
{
  using D = DiagnosticStatus;
  const StreamTimingReport timing = stream_.timing.report();
  const bool refused = recent_refusals_.areRecent();
  return firstOf(
      { { ros::Time::isSimTime() && ros::Time::now().isZero(), { D::WARN, "No time on /clock yet" } },
        { !stream_.lack.empty() && (timing.rows == 0 || hasStopped()),
          { D::WARN, "Messages on " + stream_.topic + " contain no usable row: " + stream_.lack } },
        { timing.rows == 0,
          { D::WARN, refused ? "No usable row of " + names_.joint + " yet" : "No telemetry yet on " + stream_.topic } },
        { hasStopped(), { D::WARN, "The telemetry has stopped" } },
        { recent_restarts_.areRecent(), { D::WARN, "Stamps jumped back; the twin has restarted" } },
        { refused,
          { D::WARN,
            "Messages were refused: incomplete, not finite, all efforts zero, too large, a stamp far from the clock, "
            "an impossible temperature, or a load that the node itself computes for the arm" } },
        { recent_disorder_.areRecent(), { D::WARN, "Stamps repeat or go back; the node ignores such rows" } },
        { recent_missing_.areRecent(), { D::WARN, "Rows are missing" } },
        { std::abs(timing.offset) > OFFSET_WARNING, { D::WARN, "Stamps differ from this machine's clock" } },
        { verdict_.misfit().exists(),
          { D::OK, "Telemetry arrives; friction and faults are not judged, because " + verdict_.misfit().clause } },
        { !stream_.mounting.empty(),
          { D::OK, "Telemetry arrives; " + stream_.mounting + ". The joints are judged with this mounting" } },
        { !stream_.drag.empty(),
          { D::OK, "Telemetry arrives; " + stream_.drag + ". The joints are judged with this drag" } },
        { !stream_.payload.empty(),
          { D::OK, "Telemetry arrives; " + stream_.payload + ". The joints are judged with this payload" } },
        { !tracker_.isLoadKnown(),
          { D::OK, "Telemetry arrives; friction and faults are not judged, because the load is unknown" } } },
      { D::OK, "Telemetry arrives" });
}

DiagnosticVerdict JointTracker::judgeComparison() const
{
  if (tracker_.counters().compared == 0)
  {
    return { DiagnosticStatus::STALE, "There is no row to compare" };
  }
  const Verdict verdict = verdictNow();
  const std::string text = withoutStop(verdictText(verdict));
  if (hasStopped())
  {
    return { DiagnosticStatus::STALE, "The telemetry has stopped. Last: " +
                                          (verdict.isJudged() ? levelName(verdict.level) + (". " + text) : text) };
  }
  return { static_cast<std::uint8_t>(severityOf(verdict.level)), text };
}

DiagnosticVerdict JointTracker::judgeHealth() const
{
  const Assessment& assessment = tracker_.assessment();
  if (tracker_.counters().compared == 0 && hasStopped())
  {
    return { DiagnosticStatus::STALE, "There is no window to assess" };
  }
  if (hasStopped())
  {
    return { DiagnosticStatus::STALE, "The telemetry has stopped. Last assessment: " + verdictText(assessment) };
  }
  if (const std::optional<Misfit> misfit = verdict_.whyNotJudged())
  {
    return { DiagnosticStatus::OK, notJudged(*misfit) };
  }
  const Verdict& confirmed = verdict_.confirmed();
  if (!confirmed.fits && confirmed.reason == Reason::EFFORT_UNIT)  // the indicators use the efforts too
  {
    return { DiagnosticStatus::OK, notJudged({ confirmed.reason, confirmed.misfit }) };
  }
  return { static_cast<std::uint8_t>(assessment.level), verdictText(assessment) };
}

using diagnostic_updater::DiagnosticStatusWrapper;

void JointTracker::reportTelemetry(DiagnosticStatusWrapper& status) const
{
  const StreamTimingReport timing = stream_.timing.report();
  const TrackerCounters counters = tracker_.counters();
  status.add("Topic", stream_.topic);
  status.add("Joint", names_.joint);
  status.add("Rows", timing.rows);
  status.add("Period [s]", timing.period);
  status.add("Rows missing", timing.missing);
  status.add("Longest gap [s]", timing.longest_gap);
  status.add("Gaps that cut the stream", counters.gaps);
  status.add("Stamps repeated", timing.repeated);
  status.add("Stamps going back", timing.backward);
  status.add("Restarts", counters.restarts + stream_.clock_changes);
  status.add("Reception less stamp [s]", timing.offset);
  status.add("Jitter of reception, 95 % [s]", timing.jitter);
  status.add("Unknown joint, refused", refusals_.unknown_joint);
  status.add("Names in the last message without the joint", stream_.found_names);
  status.add("Without position or effort, refused", refusals_.incomplete);
  status.add("Efforts all zero, refused", stream_.without_effort);
  status.add("Impossible angles, left out", stream_.left_out.impossible + stream_.left_out.unreachable);
  status.add("Values that repeat during a motion, left out", stream_.left_out.repeated);
  status.add("Rows with bunched stamps, left out", stream_.left_out.bunched);
  status.add("Jumps of angles by a turn, taken out", stream_.folds);
  status.add("Mounting that is not configured", stream_.mounting.empty() ? "none found" : stream_.mounting);
  status.add("Drag of the tool", stream_.drag.empty() ? "none found" : stream_.drag);
  status.add("Payload that is not configured", stream_.payload.empty() ? "none found" : stream_.payload);
  status.add("Not finite, refused", refusals_.not_finite);
  status.add("Too large, refused", stream_.too_large.load());
  status.add("Stamp far from the clock, refused", stream_.far_stamps);
  status.add("Loads refused", refusals_.load);
  status.add("Rows without a load", counters.without_load);
  status.add("Temperatures refused", refusals_.temperature);
  status.add("Temperatures of other frames", stream_.other_temperatures);
  if (last_load_stamp_)
  {
    status.add("Load's stamp before the newest row's reception [s]",
               toSeconds(stream_.last_received - *last_load_stamp_));
  }
}

void JointTracker::reportComparison(DiagnosticStatusWrapper& status) const
{
  const TrackerCounters counters = tracker_.counters();
  const std::optional<double> lag = tracker_.lag();
  const MotionReach& reach = tracker_.evidence().reach();
  const Verdict& verdict = verdict_.confirmed();
  status.add("Verdict", levelName(verdict.level));
  for (const Finding& finding : verdict.findings)
  {
    status.add(subjectTitle(finding.subject), levelName(finding.level) + (". " + findingText(verdict, finding)));
  }
  status.add("Length of the judged rows [s]", reach.end - reach.begin);
  status.add("Residual of the current [A]", comparison_.current.residual());
  status.add("Band of the current [A]", comparison_.current.band);
  status.add("Residual of the position [rad]", comparison_.position.residual());
  status.add("Residual of the velocity [rad/s]", comparison_.velocity.residual());
  status.add("Joint torque without friction [N.m]", comparison_.joint_torque);
  status.add("Load [N.m]", comparison_.load_torque);
  status.add("Temperature [degC]",
             counters.compared > 0 ? comparison_.temperature : tracker_.evidence().parameters().input.temperature);
  status.add("Source of the temperature", comparison_.temperature_received ? "received" :
                                          tracker_.hasEstimate() ? "estimated from the friction of all joints" :
                                          thermal_model_ == ThermalModel::TWO_NODES ?
                                                                   "estimated from the losses of the motion" :
                                                                   "configured");
  status.add("Common factor of the joints' friction [-]", arm_friction_);
  status.add("Rows compared", counters.compared);
  status.add("Rows outside the band", counters.outside);
  status.add("Share outside the band in the last 30 s [-]", tracker_.outsideShare());
  status.add("Steps failed", counters.solver_failures + outputs_.failures());
  if (lag)
  {
    status.add("Measured after predicted [s]", *lag);
  }
  else
  {
    status.add("Measured after predicted [s]", "unknown");
  }
}

void JointTracker::reportHealth(DiagnosticStatusWrapper& status) const
{
  addAssessment(tracker_.assessment(), status);
}
}  // namespace hjt
