// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <sensor_msgs/JointState.h>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/Assessment.h"
#include "harmonic_joint_twin/ContactForces.h"
#include "harmonic_joint_twin/Encoders.h"
#include "harmonic_joint_twin/Fault.h"
#include "harmonic_joint_twin/Faults.h"
#include "harmonic_joint_twin/Health.h"
#include "harmonic_joint_twin/Indicators.h"
#include "harmonic_joint_twin/Stress.h"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "statics/flexspline_stress.hpp"
#include "tracking/measured_gear.hpp"

namespace hjt
{
/// Least, mean and greatest value of a signal; of no value all are 0.
class SignalSpan
{
public:
  void add(double value) noexcept
  {
    least_ = count_ > 0 ? std::min(least_, value) : value;
    greatest_ = count_ > 0 ? std::max(greatest_, value) : value;
    sum_ += value;
    ++count_;
  }

  double least() const noexcept { return least_; }
  double greatest() const noexcept { return greatest_; }
  double mean() const noexcept
  {
    return count_ > 0 ? std::clamp(sum_ / static_cast<double>(count_), least_, greatest_) : 0.0;
  }

private:
  double least_{};
  double greatest_{};
  double sum_{};
  std::uint64_t count_{};
};

/// Range of a signal since a topic's last message, over the steps in which somebody listened to a topic
/// that summarises them.
struct SinceMessage
{
  SinceMessage(Stamp last = 0) : stamp(last) {}  // NOLINT(google-explicit-constructor): a stamp says all of most topics

  void add(const Twin& twin) noexcept
  {
    const JointOutputs& outputs = twin.outputs();
    torsion.add(outputs.motor_angle / nominalRatio(twin.parameters().gear) - outputs.output_angle);
    motor_torque.add(outputs.motor_torque);
    joint_torque.add(outputs.joint_torque);
  }

  Stamp stamp;              ///< of the last message [ns]
  SignalSpan torsion;       ///< [rad]
  SignalSpan motor_torque;  ///< [N.m]
  SignalSpan joint_torque;  ///< [N.m]
};

/// Names under which the joint appears in JointState messages.
struct JointNames
{
  explicit JointNames(const std::string& joint_name) : joint(joint_name), motor(joint_name + "_motor") {}

  std::string joint;
  std::string motor;
};

/// Place of a name in the message; beyond every array if it is not there.
std::size_t placeOf(const sensor_msgs::JointState& message, const std::string& name) noexcept;

// make*: a message with names and arrays in place, allocated once. fill*: the values of one instant; allocates nothing.
// As functions of a Channel they also get what passed since the topic's last message, and return false if there is
// nothing to say.

/// A message without arrays.
template <class Message>
Message makeMessage(const Parameters& parameters)
{
  Message message;
  message.header.frame_id = parameters.joint.name;
  return message;
}

/// With a position, a velocity and an effort of each.
sensor_msgs::JointState jointStatesOf(std::vector<std::string> names);

/// Order of the entries: motor, joint.
sensor_msgs::JointState makeJointStates(const Parameters& parameters);

/// Positions and velocities as the encoders see them; efforts are the applied motor torque and the joint torque [N.m].
bool fillJointStates(Twin& twin, const SinceMessage& since, sensor_msgs::JointState& message) noexcept;

bool fillEncoders(Twin& twin, const SinceMessage& since, harmonic_joint_twin::Encoders& message) noexcept;
/// The angles are the true ones [rad].
void fillEncoders(Stamp stamp, const EncoderReadings& readings, double motor_angle, double output_angle,
                  harmonic_joint_twin::Encoders& message) noexcept;

/// One entry per tooth in every array.
harmonic_joint_twin::ContactForces makeContactForces(const Parameters& parameters);
/// False: the full ring found no equilibrium.
bool fillContactForces(Twin& twin, const SinceMessage& since, harmonic_joint_twin::ContactForces& message) noexcept;
void fillContactForces(Stamp stamp, const MeasuredGear& gear, harmonic_joint_twin::ContactForces& message) noexcept;

harmonic_joint_twin::Stress makeStress(const Parameters& parameters);
bool fillStress(Twin& twin, const SinceMessage& since, harmonic_joint_twin::Stress& message) noexcept;
void fillStress(Stamp stamp, const MeasuredGear& gear, const StressParameters& parameters,
                const FatigueLaw& fatigue_law, harmonic_joint_twin::Stress& message) noexcept;

void fillSpan(const SignalSpan& span, double& least, double& mean, double& greatest) noexcept;
/// The solver's state and the spans are those of the steps after `since`.
bool fillHealth(Twin& twin, const SinceMessage& since, harmonic_joint_twin::Health& message) noexcept;

harmonic_joint_twin::Indicators makeIndicators(const Parameters& parameters);
void fillIndicators(Stamp stamp, const SignalIndicators& indicators, harmonic_joint_twin::Indicators& message) noexcept;
inline bool fillIndicators(Twin& twin, const SinceMessage& /*since*/, harmonic_joint_twin::Indicators& message) noexcept
{
  fillIndicators(twin.stamp(), twin.signalIndicators(), message);
  return true;
}
/// All but the uncertainties, which the message does not hold; NaN where it says not valid. Unknown names are left out.
SignalIndicators readIndicators(const harmonic_joint_twin::Indicators& message);

constexpr std::size_t EVIDENCE_LENGTH = 400;  ///< characters at most, the closing zero included

/// "torque_outer 0.0041 N.m, healthy 0.0003 (score 9.1); ..." into `text`; returns the length. Empty at level OK.
std::size_t writeEvidence(const Assessment& assessment, char* text, std::size_t size) noexcept;

/// "pitting 21 %; tooth_tip_crack 9 %", the same way.
std::size_t writeAlternatives(const Assessment& assessment, char* text, std::size_t size) noexcept;

harmonic_joint_twin::Assessment makeAssessment(const Parameters& parameters);
void fillAssessment(Stamp stamp, const Assessment& assessment, harmonic_joint_twin::Assessment& message) noexcept;
inline bool fillAssessment(Twin& twin, const SinceMessage& /*since*/, harmonic_joint_twin::Assessment& message) noexcept
{
  fillAssessment(twin.stamp(), twin.assessment(), message);
  return true;
}

/// Allocates.
harmonic_joint_twin::Faults makeFaults(const JointNames& names, Stamp stamp, const FaultList& faults);

/// The fault in a message, one that grows in steps; onsets count from the stamp. @returns what is wrong with it, or
/// nothing.
std::string readFault(const harmonic_joint_twin::Fault& message, const Parameters& parameters,
                      std::vector<Fault>& steps);

/// Contents of a stamped torque message.
enum class EffortStatus
{
  FOUND,
  UNKNOWN_JOINT,  ///< no entry for this joint
  MISSING_EFFORT  ///< the joint is named, but the effort array does not reach it
};

/// Motor torque [N.m] in a stamped command: the effort of the joint or, if only that is named, of its motor.
EffortStatus readMotorTorque(const sensor_msgs::JointState& message, const JointNames& names, double& torque) noexcept;

/// Load torque [N.m] in a stamped load: the effort of the joint.
EffortStatus readLoadTorque(const sensor_msgs::JointState& message, const JointNames& names, double& torque) noexcept;
}  // namespace hjt
