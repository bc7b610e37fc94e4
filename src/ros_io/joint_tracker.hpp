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
/// Zero of the time of a robot's telemetry: the stamp of the first row. Also checks whether stamps are of one clock.
class TelemetryClock
{
public:
  enum class Row
  {
    TAKEN,
    FIRST,    ///< the first row, which sets the zero of time
    MOVED,    ///< the clock of the robot or of this machine has been set; this row sets a new zero of time
    REFUSED,  ///< row whose stamp is far from the clock of the rows before; the second of two such rows is MOVED
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

  /// Time that the robot's clock shows at a time of reception [ns].
  Stamp at(Stamp received) const { return received - offset_; }
  /// Whether a stamp that was received at the time `received` can be of the robot's clock.
  bool isOf(Stamp stamp, Stamp received) const { return agree(received - stamp, offset_); }

private:
  static bool agree(Stamp a, Stamp b) { return std::abs(a - b) <= FAR_STAMP; }

  std::optional<Stamp> zero_;            // stamp of the row that sets the zero [ns]
  Stamp offset_{};                       // time of reception - stamp of the last accepted row [ns]
  std::optional<Stamp> refused_offset_;  // time of reception - stamp of the last row, if this row was refused [ns]
};

/// State of the telemetry topic of all joints of a robot. The node's mutex protects all members except `too_large`.
struct TelemetryStream
{
  std::string topic;
  TelemetryClock clock;
  StreamTiming timing;
  Stamp last_received{};               ///< time of reception of the last message [ns]
  std::uint64_t far_stamps{};          ///< number of messages that were refused because of their stamps
  std::uint64_t clock_changes{};       ///< number of restarts because the clock of the stamps had changed
  std::uint64_t other_temperatures{};  ///< number of temperatures whose frame_id is not a joint
  std::string found_names;             ///< names in the last message that lacks a joint
  std::string lack;                    ///< clause: why messages after the last row gave no row; empty: none
  std::string mounting;                ///< clause: the currents show a mounting that is not configured; empty: none
  std::string drag;                ///< clause: the currents show a drag of the tool that is not configured; empty: none
  std::string payload;             ///< clause: the currents show a payload that is not configured; empty: none
  LeftOutRows left_out;            ///< numbers of rows that the filter removed
  std::uint64_t folds{};           ///< number of jumps by a turn that were removed from the angles
  std::uint64_t without_effort{};  ///< number of messages refused because all efforts are zero
  std::atomic<std::uint64_t> too_large{ 0 };
};

/// A live topic of the node, with a count of its subscribers.
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

  /// Uses its own count of subscribers, because roscpp's count takes a lock and searches all topics.
  bool isWanted() const noexcept { return IS_LATCHED || *subscribers_ > 0; }

  Message& message() { return message_; }
  void send() { publisher_.publish(message_); }

private:
  // Messages of Comparison are published in bursts and need a longer queue than other messages.
  static constexpr std::uint32_t QUEUE_SIZE =
      std::is_same_v<Message, harmonic_joint_twin::Comparison> ? InputTopics::QUEUE_SIZE : 100;
  static constexpr bool IS_LATCHED = std::is_same_v<Message, harmonic_joint_twin::Verdict>;

  Message message_;
  std::shared_ptr<std::atomic<int>> subscribers_ = std::make_shared<std::atomic<int>>(0);
  ros::Publisher publisher_;
};

/// The live twin of one joint beside a robot: a `Tracker` with its topics, diagnostics and service. A callback
/// processes its message completely, without waiting for a clock. The node's mutex protects everything.
class JointTracker
{
public:
  /// `node`: namespace of the topics. `sound`: reference of this joint. `is_identified`: whether the parameters contain
  /// the identified friction of this joint. @throws ParameterError.
  JointTracker(ros::NodeHandle& node, const Parameters& parameters, const SoundJoint& sound, bool is_identified,
               TelemetryStream& stream, std::mutex& mutex);

  const std::string& joint() const { return names_.joint; }
  double currentPerEffort() const { return current_per_effort_; }  ///< current / effort; [A/(N.m)] for a torque
  double greatestSpeed() const { return greatest_speed_; }         ///< largest possible speed of the joint [rad/s]
  /// Whether the load is computed from the motion of the whole arm.
  bool takesArmLoad() const { return takes_arm_load_; }

  /// Reads the row of this joint from a message. Counts and logs a message without such a row. If the first messages of
  /// an arm have no efforts for this joint, the current is 0: the joint is not judged, and the other joints continue.
  TelemetryStatus read(const sensor_msgs::JointState& message, MotionRow& row);

  /// Begins at a new zero of the stream's time. `reset`: whether the earlier rows are discarded.
  void start(bool reset);

  void pushLoad(double time, double torque) { tracker_.pushLoad(time, torque); }
  void push(const MotionRow& row);        ///< compares the row of a single joint with the twin
  void compare(const MotionSample& row);  ///< compares the row of a joint of an arm with the twin

  /// Sets the misfit of the telemetry. Without a misfit the telemetry fits, or the check is not yet `settled`.
  void setMisfit(const Misfit& misfit, bool settled);
  void setFitted(const FittedFriction& friction) { verdict_.setFitted(friction); }

  Tracker& tracker() { return tracker_; }

  /// Sets the common factor of the friction of the arm's joints, relative to the expected friction [-]; 1 without a
  /// common factor, or if the twin's prediction contains the factor.
  void setArmFriction(double ratio) { arm_friction_ = ratio; }

  VerdictWatch& verdict() { return verdict_; }
  bool isTouched() const { return tracker_.evidence().isTouched(); }
  void receiveLoad(const sensor_msgs::JointState& message, Stamp received);

  /// Reads a message with the temperature of this joint.
  void receiveTemperature(const sensor_msgs::Temperature& message, Stamp received);

  /// Publishes the verdict, reports diagnostics, and logs changes of the state.
  void look(const ros::WallTime& now);

private:
  /// Numbers of messages that the node refused, by reason.
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
    std::optional<Stamp> stamp;  // stamp of the message; none: the temperature is valid from its reception on [ns]
    Stamp received;              // time of reception [ns]
    double temperature;          // received temperature [degC]
  };

  struct LoadAt
  {
    std::optional<Stamp> stamp;  // stamp of the message; none: the load is valid from its reception on [ns]
    Stamp received;              // time of reception [ns]
    double torque;               // received load [N.m]
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
  const std::string name_;  // name of the twin in the ROS graph
  const JointNames names_;
  const bool takes_arm_load_;
  const ThermalModel thermal_model_;
  const double ratio_;                          // motor angle / output angle [-]
  const double greatest_speed_;                 // largest possible speed of the joint [rad/s]
  const double current_per_effort_;             // current / effort; [A/(N.m)] if the effort is a torque
  static constexpr std::uint64_t SILENT = 100;  // number of messages without effort, after which the current is 0
  std::uint64_t without_effort_{};              // number of successive messages without an effort
  bool has_effort_{};                           // whether a message has had an effort
  double arm_friction_{ 1.0 };
  Tracker tracker_;
  VerdictWatch verdict_;
  TrackerOutputs<PublishedTopic> outputs_;
  LifePublisher life_;
  std::optional<Stamp> last_load_stamp_;            // stamp of the last load [ns]
  std::deque<LoadAt> early_loads_;                  // loads received before the first row
  std::optional<TemperatureAt> early_temperature_;  // last temperature received before the first row
  Refusals refusals_;
  Comparison comparison_;  // last comparison
  RecentEvents recent_refusals_;
  RecentEvents recent_disorder_;
  RecentEvents recent_missing_;
  RecentEvents recent_restarts_;
  RecentEvents recent_failures_;
  std::optional<std::pair<VerdictLevel, Reason>> published_;  // level and reason of the last published verdict
  double published_row_{};                                    // time of the last row of the published verdict [s]
  std::optional<std::uint8_t> logged_level_;
  DiagnosticTasks tasks_;
  ros::ServiceServer reset_service_;
  ros::Subscriber load_torque_subscriber_;
};
}  // namespace hjt
