// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ros_io/measured_drive.hpp"
#include "ros_io/stamp_periods.hpp"
#include "ros_io/telemetry_messages.hpp"
#include "ros_io/topics.hpp"

namespace hjt
{
/// Names of the topics of TrackerOutputs below `joint_namespace`.
inline std::vector<std::string> trackerTopics(const std::string& joint_namespace)
{
  std::vector<std::string> names;
  for (const char* name : { topics::COMPARISON, topics::INDICATORS, topics::ASSESSMENT, topics::CONTACT_FORCES,
                            topics::ENCODERS, topics::HEALTH, topics::STRESS })
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
    , contact_forces_periods_(parameters.publish.contact_forces_rate)
    , encoders_periods_(parameters.publish.encoders_rate)
    , health_periods_(parameters.publish.health_rate)
    , stress_periods_(parameters.publish.stress_rate)
    , comparison_(context, topics::COMPARISON, makeMessage<harmonic_joint_twin::Comparison>(parameters))
    , indicators_(context, topics::INDICATORS, makeIndicators(parameters))
    , assessment_(context, topics::ASSESSMENT, makeAssessment(parameters))
    , contact_forces_(context, topics::CONTACT_FORCES, makeContactForces(parameters))
    , encoders_(context, topics::ENCODERS, makeMessage<harmonic_joint_twin::Encoders>(parameters))
    , health_(context, topics::HEALTH, makeMessage<harmonic_joint_twin::Health>(parameters))
    , stress_(context, topics::STRESS, makeStress(parameters))
  {
  }

  /// After each comparison of the tracker.
  void offer(Stamp stamp, const Comparison& comparison, const Tracker& tracker)
  {
    fillComparison(stamp, comparison, comparison_.message());
    comparison_.send();
    if (report_periods_.begins(stamp))
    {
      fillIndicators(stamp, tracker.signalIndicators(), indicators_.message());
      indicators_.send();
      fillAssessment(stamp, tracker.assessment(), assessment_.message());
      assessment_.send();
    }
    const bool forces_due = contact_forces_periods_.begins(stamp) && contact_forces_.isWanted();
    const bool encoders_due = encoders_periods_.begins(stamp) && encoders_.isWanted();
    const bool health_due = health_periods_.begins(stamp) && health_.isWanted();
    const bool stress_due = stress_periods_.begins(stamp) && stress_.isWanted();
    if ((!forces_due && !encoders_due && !health_due && !stress_due) || !drive_.moveTo(comparison))
    {
      return;
    }
    if (forces_due)
    {
      drive_.fill(stamp, contact_forces_.message());
      contact_forces_.send();
    }
    if (encoders_due)
    {
      drive_.fill(stamp, encoders_periods_.number(), encoders_.message());
      encoders_.send();
    }
    if (health_due)
    {
      drive_.fill(stamp, health_.message());
      health_.send();
    }
    if (stress_due)
    {
      drive_.fill(stamp, stress_.message());
      stress_.send();
    }
  }

  std::uint64_t failures() const { return drive_.failures(); }  ///< instants without an equilibrium

private:
  MeasuredDrive drive_;
  StampPeriods report_periods_;
  StampPeriods contact_forces_periods_;
  StampPeriods encoders_periods_;
  StampPeriods health_periods_;
  StampPeriods stress_periods_;
  Sink<harmonic_joint_twin::Comparison> comparison_;
  Sink<harmonic_joint_twin::Indicators> indicators_;
  Sink<harmonic_joint_twin::Assessment> assessment_;
  Sink<harmonic_joint_twin::ContactForces> contact_forces_;
  Sink<harmonic_joint_twin::Encoders> encoders_;
  Sink<harmonic_joint_twin::Health> health_;
  Sink<harmonic_joint_twin::Stress> stress_;
};
}  // namespace hjt
