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
/// Least, mean and greatest value of a signal; all three are 0 if there are no values.
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

/// Ranges of signals since the last message of a topic. They cover only steps in which the topic had subscribers.
struct SinceMessage
{
  SinceMessage(Stamp last = 0) : stamp(last) {}  // conversion from a stamp, because most topics need only the stamp

  void add(const Twin& twin) noexcept
  {
    const JointOutputs& outputs = twin.outputs();
    torsion.add(outputs.motor_angle / nominalRatio(twin.parameters().gear) - outputs.output_angle);
    motor_torque.add(outputs.motor_torque);
    joint_torque.add(outputs.joint_torque);
  }

  Stamp stamp;              ///< stamp of the last message [ns]
  SignalSpan torsion;       ///< torsion of the drive [rad]
  SignalSpan motor_torque;  ///< torque of the motor [N.m]
  SignalSpan joint_torque;  ///< torque of the mesh on the circular spline [N.m]
};

/// Names of a joint and of its motor in JointState messages.
struct JointNames
{
  explicit JointNames(const std::string& joint_name) : joint(joint_name), motor(joint_name + "_motor") {}

  std::string joint;
  std::string motor;
};

/// Index of a name in the message. If the name is missing, the index is beyond the end of all arrays.
std::size_t placeOf(const sensor_msgs::JointState& message, const std::string& name) noexcept;

// Functions make* return a message whose names and arrays they allocate. Functions fill* write the values of one
// instant into a message and do not allocate. If fill* is a member of a Channel, it also gets the ranges since the last
// message of the topic, and returns false if there is nothing to publish.

/// Makes a message without arrays.
template <class Message>
Message makeMessage(const Parameters& parameters)
{
  Message message;
  message.header.frame_id = parameters.joint.name;
  return message;
}

/// Makes a message with a position, a velocity and an effort for each name.
sensor_msgs::JointState jointStatesOf(std::vector<std::string> names);

/// Makes a message with an entry for the motor, followed by an entry for the joint.
sensor_msgs::JointState makeJointStates(const Parameters& parameters);

/// Positions [rad] and velocities [rad/s] are readings of the encoders. Efforts are the applied motor torque and the
/// joint torque [N.m].
bool fillJointStates(Twin& twin, const SinceMessage& since, sensor_msgs::JointState& message) noexcept;

bool fillEncoders(Twin& twin, const SinceMessage& since, harmonic_joint_twin::Encoders& message) noexcept;
/// `motor_angle` and `output_angle` are the true angles [rad].
void fillEncoders(Stamp stamp, const EncoderReadings& readings, double motor_angle, double output_angle,
                  harmonic_joint_twin::Encoders& message) noexcept;

/// Makes a message with arrays that have one entry for each tooth.
harmonic_joint_twin::ContactForces makeContactForces(const Parameters& parameters);
/// @returns false if the full ring has no equilibrium.
bool fillContactForces(Twin& twin, const SinceMessage& since, harmonic_joint_twin::ContactForces& message) noexcept;
void fillContactForces(Stamp stamp, const MeasuredGear& gear, harmonic_joint_twin::ContactForces& message) noexcept;

harmonic_joint_twin::Stress makeStress(const Parameters& parameters);
bool fillStress(Twin& twin, const SinceMessage& since, harmonic_joint_twin::Stress& message) noexcept;
void fillStress(Stamp stamp, const MeasuredGear& gear, const StressParameters& parameters,
                const FatigueLaw& fatigue_law, harmonic_joint_twin::Stress& message) noexcept;

void fillSpan(const SignalSpan& span, double& least, double& mean, double& greatest) noexcept;
/// The state of the solver and the ranges of the signals cover the steps after `since`.
bool fillHealth(Twin& twin, const SinceMessage& since, harmonic_joint_twin::Health& message) noexcept;

harmonic_joint_twin::Indicators makeIndicators(const Parameters& parameters);
void fillIndicators(Stamp stamp, const SignalIndicators& indicators, harmonic_joint_twin::Indicators& message) noexcept;
inline bool fillIndicators(Twin& twin, const SinceMessage& /*since*/, harmonic_joint_twin::Indicators& message) noexcept
{
  fillIndicators(twin.stamp(), twin.signalIndicators(), message);
  return true;
}
/// Reads the values of a message; a value that is not valid is NaN. Unknown names are ignored.
SignalIndicators readIndicators(const harmonic_joint_twin::Indicators& message);

constexpr std::size_t EVIDENCE_LENGTH = 400;  ///< largest number of characters of a text, including the closing zero

/// Writes a text such as "torque_outer 0.0041 N.m, healthy 0.0003 (score 9.1); ..." and returns its length. At level OK
/// the text is empty.
std::size_t writeEvidence(const Assessment& assessment, char* text, std::size_t size) noexcept;

/// Writes a text such as "pitting 21 %; tooth_tip_crack 9 %" and returns its length.
std::size_t writeAlternatives(const Assessment& assessment, char* text, std::size_t size) noexcept;

harmonic_joint_twin::Assessment makeAssessment(const Parameters& parameters);
void fillAssessment(Stamp stamp, const Assessment& assessment, harmonic_joint_twin::Assessment& message) noexcept;
inline bool fillAssessment(Twin& twin, const SinceMessage& /*since*/, harmonic_joint_twin::Assessment& message) noexcept
{
  fillAssessment(twin.stamp(), twin.assessment(), message);
  return true;
}

/// Makes the message about the active faults. Allocates.
harmonic_joint_twin::Faults makeFaults(const JointNames& names, Stamp stamp, const FaultList& faults);

/// Reads a fault from a message. A fault that grows becomes several steps, whose onsets are counted from the stamp.
/// @returns the error; empty if the message is valid.
std::string readFault(const harmonic_joint_twin::Fault& message, const Parameters& parameters,
                      std::vector<Fault>& steps);

/// Result of reading a torque from a message.
enum class EffortStatus
{
  FOUND,
  UNKNOWN_JOINT,  ///< the message does not name this joint
  MISSING_EFFORT  ///< the message names the joint, but the effort array is too short
};

/// Reads the motor torque [N.m] of a command: the effort of the joint or, if the message lacks the joint, of its motor.
EffortStatus readMotorTorque(const sensor_msgs::JointState& message, const JointNames& names, double& torque) noexcept;

/// Reads the load torque [N.m] from a message: the effort of the joint.
EffortStatus readLoadTorque(const sensor_msgs::JointState& message, const JointNames& names, double& torque) noexcept;
}  // namespace hjt
