// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <sensor_msgs/JointState.h>

#include "harmonic_joint_twin/Comparison.h"
#include "harmonic_joint_twin/Verdict.h"
#include "messages/conversions.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"
#include "sensors/joint_sensors.hpp"
#include "tracking/measured_gear.hpp"
#include "tracking/tracker.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
/// Result of reading a joint from a message of a robot's telemetry.
enum class TelemetryStatus
{
  FOUND,
  UNKNOWN_JOINT,  ///< the message does not name this joint
  INCOMPLETE,     ///< the message names the joint, but lacks its position or effort
  NOT_FINITE,     ///< the position is NaN or infinite
  WITHOUT_EFFORT  ///< the effort is NaN or infinite; the other values of the row are valid
};

/// Reads position [rad] and velocity [rad/s], if present, of the joint, its effort as a current, and the position of
/// its motor, if the message names the motor. Times and load of the row are not changed.
TelemetryStatus readTelemetry(const sensor_msgs::JointState& message, const JointNames& names, MotionRow& row) noexcept;

/// @param stamp stamp of the row [ns].
void fillComparison(Stamp stamp, const Comparison& comparison, harmonic_joint_twin::Comparison& message) noexcept;

/// @param stamp stamp of the last judged row [ns]. The function allocates.
void fillVerdict(Stamp stamp, const Verdict& verdict, harmonic_joint_twin::Verdict& message);

/// The gear of a measured joint, computed at the measured angle under the present torque. It fills the messages on
/// teeth, encoders, stress and health of this joint.
class MeasuredDrive
{
public:
  /// @throws ParameterError if the wave generator cannot be inserted.
  explicit MeasuredDrive(const Parameters& parameters);

  /// Moves the gear to the row of a comparison; the next calls of `fill` publish this row. @returns false if the gear
  /// has no equilibrium there, and counts such rows. Neither throws nor allocates.
  bool moveTo(const Comparison& comparison) noexcept;
  std::uint64_t failures() const noexcept { return failures_; }

  /// Adds the torques of a row to the ranges in the next Health message, or clears the ranges if no message is wanted.
  void note(const Comparison& comparison, bool is_wanted) noexcept;

  void fill(Stamp stamp, harmonic_joint_twin::ContactForces& message) noexcept;
  void fill(Stamp stamp, harmonic_joint_twin::Stress& message) noexcept;
  /// The encoders' noise depends only on the number of the period of publish.encoders_rate that contains the stamp.
  void fill(Stamp stamp, harmonic_joint_twin::Encoders& message) noexcept;
  /// Writes the values of one instant. The values that have a flag `*_valid` are not valid.
  void fill(Stamp stamp, harmonic_joint_twin::Health& message) noexcept;

private:
  double motorTorque(const Comparison& comparison) const noexcept;
  double meshForceError() const noexcept;  // expected error of the mesh forces [N]

  const GearParameters dimensions_;
  const RingParameters ring_;
  const StressParameters stress_;
  const FatigueLaw fatigue_law_;
  const TelemetryParameters telemetry_;
  const Stamp encoders_period_;  // period of the encoders' samples [ns]
  const double ratio_;
  MeasuredGear gear_;
  JointSensors sensors_;
  Comparison now_;
  double motor_torque_{};  // torque of the motor in the present row [N.m]
  SinceMessage since_;     // ranges for the next Health message
  std::uint64_t failures_{};
};

/// Periods of a topic, counted from the epoch. So equal stamps begin equal periods, both live and replayed.
class StampPeriods
{
public:
  explicit StampPeriods(double rate) : length_(toStampLength(1.0 / rate)) {}  ///< rate in [Hz]

  /// Whether the stamp is the first one in its period.
  bool begins(Stamp stamp)
  {
    const std::int64_t number = stamp / length_;
    return std::exchange(number_, number) != number;
  }

  std::int64_t number() const { return number_; }  ///< number of the period that contains the last stamp

private:
  Stamp length_;  // length of a period [ns]
  std::int64_t number_{};
};

/// Names of all topics of TrackerOutputs in `joint_namespace`.
inline std::vector<std::string> trackerTopics(const std::string& joint_namespace)
{
  std::vector<std::string> names;
  for (const char* name : { topics::COMPARISON, topics::INDICATORS, topics::ASSESSMENT, topics::CONTACT_FORCES,
                            topics::ENCODERS, topics::HEALTH, topics::STRESS, topics::VERDICT })
  {
    names.push_back(joint_namespace + "/" + name);
  }
  return names;
}

/// The topics of one joint beside a robot, each with a `Sink<Message>` for its messages. The ring is solved only if a
/// message that needs it is due and wanted.
///
/// A sink is constructed from (context, topic name, first message). Its members are `bool isWanted()`, `Message&
/// message()`, which the caller fills, and `send()`.
template <template <class> class Sink>
class TrackerOutputs
{
public:
  /// @throws ParameterError if the wave generator cannot be inserted.
  template <class Context>
  TrackerOutputs(Context&& context, const Parameters& parameters)
    : drive_(parameters)
    , report_periods_(parameters.publish.indicators_rate)
    , comparison_(context, topics::COMPARISON, makeMessage<harmonic_joint_twin::Comparison>(parameters))
    , indicators_(context, topics::INDICATORS, makeIndicators(parameters))
    , assessment_(context, topics::ASSESSMENT, makeAssessment(parameters))
    , verdict_(context, topics::VERDICT, makeMessage<harmonic_joint_twin::Verdict>(parameters))
    , ring_topics_(RingTopic<harmonic_joint_twin::ContactForces>{ StampPeriods(parameters.publish.contact_forces_rate),
                                                                  { context, topics::CONTACT_FORCES,
                                                                    makeContactForces(parameters) } },
                   RingTopic<harmonic_joint_twin::Encoders>{
                       StampPeriods(parameters.publish.encoders_rate),
                       { context, topics::ENCODERS, makeMessage<harmonic_joint_twin::Encoders>(parameters) } },
                   RingTopic<harmonic_joint_twin::Health>{
                       StampPeriods(parameters.publish.health_rate),
                       { context, topics::HEALTH, makeMessage<harmonic_joint_twin::Health>(parameters) } },
                   RingTopic<harmonic_joint_twin::Stress>{ StampPeriods(parameters.publish.stress_rate),
                                                           { context, topics::STRESS, makeStress(parameters) } })
  {
  }

  /// The caller calls this function after each comparison of the tracker.
  void offer(Stamp stamp, const Comparison& comparison, const Tracker& tracker)
  {
    if (comparison_.isWanted())
    {
      fillComparison(stamp, comparison, comparison_.message());
      comparison_.send();
    }
    if (report_periods_.begins(stamp))
    {
      fillIndicators(stamp, tracker.signalIndicators(), indicators_.message());
      indicators_.send();
      fillAssessment(stamp, tracker.assessment(), assessment_.message());
      assessment_.send();
    }
    drive_.note(comparison, std::get<RingTopic<harmonic_joint_twin::Health>>(ring_topics_).sink.isWanted());
    bool is_any_due = false;
    const auto look = [&](auto& topic)
    {
      topic.is_due = topic.periods.begins(stamp) && topic.sink.isWanted();
      is_any_due = is_any_due || topic.is_due;
    };
    std::apply([&](auto&... topic) { (look(topic), ...); }, ring_topics_);
    if (!is_any_due || !drive_.moveTo(comparison))
    {
      return;
    }
    const auto send = [&](auto& topic)
    {
      if (topic.is_due)
      {
        drive_.fill(stamp, topic.sink.message());
        topic.sink.send();
      }
    };
    std::apply([&](auto&... topic) { (send(topic), ...); }, ring_topics_);
  }

  /// `stamp`: stamp of the last judged row [ns].
  void offer(Stamp stamp, const Verdict& verdict)
  {
    fillVerdict(stamp, verdict, verdict_.message());
    verdict_.send();
  }

  std::uint64_t failures() const { return drive_.failures(); }  ///< number of rows without an equilibrium

private:
  /// A topic whose messages need the solved ring.
  template <class Message>
  struct RingTopic
  {
    StampPeriods periods;
    Sink<Message> sink;
    bool is_due{};
  };

  MeasuredDrive drive_;
  StampPeriods report_periods_;
  Sink<harmonic_joint_twin::Comparison> comparison_;
  Sink<harmonic_joint_twin::Indicators> indicators_;
  Sink<harmonic_joint_twin::Assessment> assessment_;
  Sink<harmonic_joint_twin::Verdict> verdict_;
  std::tuple<RingTopic<harmonic_joint_twin::ContactForces>, RingTopic<harmonic_joint_twin::Encoders>,
             RingTopic<harmonic_joint_twin::Health>, RingTopic<harmonic_joint_twin::Stress>>
      ring_topics_;
};
}  // namespace hjt
