// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Temperature.h>
#include <std_msgs/Float64.h>
#include <std_srvs/Trigger.h>

#include "messages/time.hpp"
#include "messages/tracker_messages.hpp"
#include "ros_io/diagnostic_tasks.hpp"
#include "ros_io/diagnostics.hpp"
#include "ros_io/input_subscribers.hpp"
#include "ros_io/life_publisher.hpp"
#include "tracking/sound_joint.hpp"
#include "tracking/telemetry_rows.hpp"
#include "tracking/tracker.hpp"
#include "tracking/verdict_watch.hpp"

namespace hjt
{
/// Zero of a robot's telemetry, the stamp of its first row, and whether stamps are of the same clock.
class TelemetryClock
{
public:
  enum class Row
  {
    TAKEN,
    FIRST,    ///< sets the zero
    MOVED,    ///< the clock of the robot or this machine's was set: a new zero
    REFUSED,  ///< far from where the rows before lead to; the next one like it counts as MOVED
  };

  Row take(Stamp stamp, Stamp received)
  {
    const Stamp offset = received - stamp;
    const bool moved = zero_ && !agree(offset, offset_);
    if (moved && !(refused_offset_ && agree(offset, *refused_offset_)))
    {
      refused_offset_ = offset;
      return Row::REFUSED;
    }
    const bool first = !zero_;
    refused_offset_.reset();
    offset_ = offset;
    if (first || moved)
    {
      zero_ = stamp;
    }
    return moved ? Row::MOVED : first ? Row::FIRST : Row::TAKEN;
  }

  bool hasStarted() const { return zero_.has_value(); }
  double seconds(Stamp stamp) const { return toSeconds(stamp - *zero_); }
  Stamp stamp(double seconds) const { return *zero_ + std::llround(1e9 * seconds); }

  /// Time of this clock at a time of reception [ns].
  Stamp at(Stamp received) const { return received - offset_; }
  /// Whether a stamp received then can be of this clock.
  bool isOf(Stamp stamp, Stamp received) const { return agree(received - stamp, offset_); }

private:
  static bool agree(Stamp a, Stamp b) { return std::abs(a - b) <= FAR_STAMP; }

  std::optional<Stamp> zero_;            // [ns]
  Stamp offset_{};                       // of the last row taken: reception less stamp [ns]
  std::optional<Stamp> refused_offset_;  // of the last row, if its stamp was refused [ns]
};

/// The messages of one topic, which all joints of a robot share. Guarded by the node's mutex but for `too_large`.
struct TelemetryStream
{
  std::string topic;
  TelemetryClock clock;
  StreamTiming timing;
  Stamp last_received{};               ///< [ns]
  std::uint64_t far_stamps{};          ///< messages refused for their stamp
  std::uint64_t clock_changes{};       ///< restarts because all stamps had moved far
  std::uint64_t other_temperatures{};  ///< received whose frame_id is none of the joints
  std::string found_names;             ///< in the last message that lacks a joint
  std::string lack;                    ///< missing parts of the messages since the last row, a clause; empty: none
  std::string mounting;                ///< that the currents show and is not configured, a clause; empty: none
  std::string drag;                    ///< of the tool, likewise
  std::string payload;                 ///< that the currents show and is not configured, a clause; empty: none
  LeftOutRows left_out;                ///< by the filter
  std::uint64_t folds{};               ///< jumps by a turn that were taken out of the angles
  std::uint64_t without_effort{};      ///< messages refused for efforts all zero
  std::atomic<std::uint64_t> too_large{ 0 };
};

/// Sink of a topic that is published live.
template <class Message>
class PublishedTopic
{
public:
  PublishedTopic(ros::NodeHandle& node, const char* name, Message first) : message_(std::move(first))
  {
    const auto count = [this](int by)
    { return [of = subscribers_, by](const ros::SingleSubscriberPublisher&) { *of += by; }; };
    publisher_ = node.advertise<Message>(name, QUEUE_SIZE, count(1), count(-1), ros::VoidConstPtr(), IS_LATCHED);
  }

  /// Counted, because to ask roscpp takes its lock and a search of all topics.
  bool isWanted() const noexcept { return IS_LATCHED || *subscribers_ > 0; }

  Message& message() { return message_; }
  void send() { publisher_.publish(message_); }

private:
  // Comparisons come in bursts.
  static constexpr std::uint32_t QUEUE_SIZE =
      std::is_same_v<Message, harmonic_joint_twin::Comparison> ? InputTopics::QUEUE_SIZE : 100;
  static constexpr bool IS_LATCHED = std::is_same_v<Message, harmonic_joint_twin::Verdict>;

  Message message_;
  std::shared_ptr<std::atomic<int>> subscribers_ = std::make_shared<std::atomic<int>>(0);
  ros::Publisher publisher_;
};

/// The twin of one joint beside a robot, live: a `Tracker` with its topics, diagnostics and service. Whatever a message
/// brings is worked off in its callback: nothing here waits for a clock. The node's mutex guards everything.
class JointTracker
{
public:
  /// `node`: its topics lie below. `sound`: what is known of this joint. `is_identified`: the friction of the
  /// parameters is that of this joint. @throws ParameterError.
  JointTracker(ros::NodeHandle& node, const Parameters& parameters, const SoundJoint& sound, bool is_identified,
               TelemetryStream& stream, std::mutex& mutex);

  const std::string& joint() const { return names_.joint; }
  double currentPerEffort() const { return current_per_effort_; }  ///< [A], [A/(N.m)]
  double greatestSpeed() const { return greatest_speed_; }         ///< [rad/s]
  /// Its load comes with `pushLoad` from the motion of the whole arm.
  bool takesArmLoad() const { return takes_arm_load_; }

  /// The row of this joint in a message; anything else is counted and logged. A joint of an arm that has sent no effort
  /// in its first messages is read with current 0: it is not judged, and the others are not held up.
  TelemetryStatus read(const sensor_msgs::JointState& message, MotionRow& row);

  /// A new zero of the stream's time; `reset`: what was before is of another clock.
  void start(bool reset);

  void pushLoad(double time, double torque) { tracker_.pushLoad(time, torque); }
  void push(const MotionRow& row);        ///< of a single joint
  void compare(const MotionSample& row);  ///< of an arm's

  /// Misfit of its telemetry; none: it fits, or that is not yet `settled`.
  void setMisfit(const Misfit& misfit, bool settled);
  void setFitted(const FittedFriction& friction) { verdict_.setFitted(friction); }

  Tracker& tracker() { return tracker_; }

  /// Common factor of the friction of the arm's joints now, as a multiple of the expected of this one [-]; 1:
  /// nothing, or the twin predicts with it.
  void setArmFriction(double ratio) { arm_friction_ = ratio; }

  VerdictWatch& verdict() { return verdict_; }
  bool isTouched() const { return tracker_.evidence().isTouched(); }
  /// A message on the load's topic.
  void receiveLoad(const sensor_msgs::JointState& message, Stamp received);

  /// A message of this joint on the temperatures' topic.
  void receiveTemperature(const sensor_msgs::Temperature& message, Stamp received);

  /// Judges, reports and logs changes of the state.
  void look(const ros::WallTime& now);

private:
  /// Messages that brought nothing.
  struct Refusals
  {
    std::uint64_t unknown_joint{};
    std::uint64_t incomplete{};
    std::uint64_t not_finite{};
    std::uint64_t load{};
    std::uint64_t temperature{};
  };

  struct TemperatureAt
  {
    std::optional<Stamp> stamp;  // none: valid from its reception on [ns]
    Stamp received;              // [ns]
    double temperature;          // [degC]
  };

  struct LoadAt
  {
    std::optional<Stamp> stamp;  // none: valid from its reception on [ns]
    Stamp received;              // [ns]
    double torque;               // [N.m]
  };

  void receiveLoadTorque(const ros::MessageEvent<const std_msgs::Float64>& event);
  void takeLoad(const LoadAt& load);
  void passLoad(const LoadAt& load);
  void passTemperature(const TemperatureAt& temperature);
  void forgetAll();
  void publish(const Comparison& comparison);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  Verdict verdictNow() const;
  void publishVerdict();
  bool hasStopped() const;
  DiagnosticVerdict judgeTelemetry() const;
  DiagnosticVerdict judgeComparison() const;
  DiagnosticVerdict judgeHealth() const;
  void logState();
  void reportTelemetry(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void reportComparison(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void reportHealth(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  TelemetryStream& stream_;
  std::mutex& mutex_;
  const std::string name_;  // of the twin in the graph
  const JointNames names_;
  const bool takes_arm_load_;
  const ThermalModel thermal_model_;
  const double ratio_;                          // of motor to output
  const double greatest_speed_;                 // [rad/s]
  const double current_per_effort_;             // [A], [A/(N.m)]
  static constexpr std::uint64_t SILENT = 100;  // messages
  std::uint64_t without_effort_{};              // messages one after the other
  bool has_effort_{};                           // of a message
  double arm_friction_{ 1.0 };
  Tracker tracker_;
  VerdictWatch verdict_;
  TrackerOutputs<PublishedTopic> outputs_;
  LifePublisher life_;
  std::optional<Stamp> last_load_stamp_;            // [ns]
  std::deque<LoadAt> early_loads_;                  // received before the start
  std::optional<TemperatureAt> early_temperature_;  // the last received before the start
  Refusals refusals_;
  Comparison comparison_;  // the last one
  RecentEvents recent_refusals_;
  RecentEvents recent_disorder_;
  RecentEvents recent_missing_;
  RecentEvents recent_restarts_;
  RecentEvents recent_failures_;
  std::optional<std::pair<VerdictLevel, Reason>> published_;  // the last one
  double published_row_{};                                    // time of its last row [s]
  std::optional<std::uint8_t> logged_level_;
  DiagnosticTasks tasks_;
  ros::ServiceServer reset_service_;
  ros::Subscriber load_torque_subscriber_;
};
}  // namespace hjt
