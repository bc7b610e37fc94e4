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
/// Values of a joint in a robot's telemetry.
enum class TelemetryStatus
{
  FOUND,
  UNKNOWN_JOINT,  ///< no entry for this joint
  INCOMPLETE,     ///< named, but without a position or an effort
  NOT_FINITE,     ///< the position is NaN or Inf
  WITHOUT_EFFORT  ///< a position, but the effort is NaN or Inf: the row holds all but the current
};

/// Position [rad], velocity if there is one [rad/s] and effort, as current, of the joint; where the message names its
/// motor too, that one's position. Times and load of the row stay as they are.
TelemetryStatus readTelemetry(const sensor_msgs::JointState& message, const JointNames& names, MotionRow& row) noexcept;

/// @param stamp of the row [ns].
void fillComparison(Stamp stamp, const Comparison& comparison, harmonic_joint_twin::Comparison& message) noexcept;

/// @param stamp of the last row that was judged [ns]. Allocates.
void fillVerdict(Stamp stamp, const Verdict& verdict, harmonic_joint_twin::Verdict& message);

/// The drive of a measured joint, and what its messages hold: the gear at the measured angle under the joint's torque
/// of the moment.
class MeasuredDrive
{
public:
  /// @throws ParameterError as MeasuredGear.
  explicit MeasuredDrive(const Parameters& parameters);

  /// To the row of a comparison; `fill` is of that one. False: no equilibrium, counted. Neither throws nor allocates.
  bool moveTo(const Comparison& comparison) noexcept;
  std::uint64_t failures() const noexcept { return failures_; }

  /// Takes the torques of a row into those of the next Health; where none is wanted they are forgotten.
  void note(const Comparison& comparison, bool is_wanted) noexcept;

  void fill(Stamp stamp, harmonic_joint_twin::ContactForces& message) noexcept;
  void fill(Stamp stamp, harmonic_joint_twin::Stress& message) noexcept;
  /// The noise of the sensors is that of the sample in the stamp's period of publish.encoders_rate.
  void fill(Stamp stamp, harmonic_joint_twin::Encoders& message) noexcept;
  /// Values of one instant; those that take a turn of the drive are not valid.
  void fill(Stamp stamp, harmonic_joint_twin::Health& message) noexcept;

private:
  double motorTorque(const Comparison& comparison) const noexcept;
  double meshForceError() const noexcept;  // [N]

  const GearParameters dimensions_;
  const RingParameters ring_;
  const StressParameters stress_;
  const FatigueLaw fatigue_law_;
  const TelemetryParameters telemetry_;
  const Stamp encoders_period_;  // [ns]
  const double ratio_;
  MeasuredGear gear_;
  JointSensors sensors_;
  Comparison now_;
  double motor_torque_{};  // [N.m]
  SinceMessage since_;     // that of Health
  std::uint64_t failures_{};
};

/// Periods of a topic, counted from the epoch: the same stamps begin the same periods, live and replayed.
class StampPeriods
{
public:
  explicit StampPeriods(double rate) : length_(toStampLength(1.0 / rate)) {}  ///< [Hz]

  /// Whether a stamp is the first in its period.
  bool begins(Stamp stamp)
  {
    const std::int64_t number = stamp / length_;
    return std::exchange(number_, number) != number;
  }

  std::int64_t number() const { return number_; }  ///< of the last stamp's period

private:
  Stamp length_;  // [ns]
  std::int64_t number_{};
};

/// Names of the topics of TrackerOutputs below `joint_namespace`.
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

/// The topics of one joint beside a robot, each with a `Sink<Message>` that its messages go to. The ring is solved only
/// for messages that are due and wanted.
///
/// A sink is constructed from (context, topic's name, first message) and has `bool isWanted()`, `Message& message()`,
/// to be filled, and `send()`.
template <template <class> class Sink>
class TrackerOutputs
{
public:
  /// @throws ParameterError as MeasuredGear.
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

  /// After each comparison of the tracker.
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

  /// `stamp`: of the last row that was judged.
  void offer(Stamp stamp, const Verdict& verdict)
  {
    fillVerdict(stamp, verdict, verdict_.message());
    verdict_.send();
  }

  std::uint64_t failures() const { return drive_.failures(); }  ///< instants without an equilibrium

private:
  /// A topic that the ring is solved for.
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
