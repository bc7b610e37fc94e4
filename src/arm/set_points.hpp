// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_description.hpp"
#include "arm/arm_dynamics.hpp"
#include "arm/arm_motion.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Reads set points from a CSV file, or from a program of moves if the path ends with .yaml. The CSV file is a
/// recording of a controller, or a motion that `joint_twin checkup` wrote. Its columns are `timestamp` or `time` [s],
/// `target_q_0` and so on [rad], and optionally `target_qd_0`, `target_qdd_0` and so on. @throws InputError,
/// ParameterError.
std::vector<ArmSetPoint> readSetPoints(const std::string& path, const ArmDescription& arm);

/// Computes missing speeds and accelerations from differences of the angles. If the speeds are missing, a joint rests
/// at the first and the last set point, unless it would need more than 10 rad/s^2 to start or stop within one row, as
/// in a piece of a longer motion.
void fillRates(std::vector<ArmSetPoint>& points, bool has_velocity, bool has_acceleration);

/// Corrects the times of set points whose stamps jitter, for example because a program stamped the rows when it
/// received them. The time between two rows becomes the time that the joints need from row to row at their speeds. The
/// times stay if the speeds are not the rates of the angles, or if the stamps fit the speeds. Returns the largest
/// change of the time between two rows [s]; 0: no change.
double straightenTimes(std::vector<ArmSetPoint>& points);

/// Text of the warning that straightenTimes() changed the times. `change`: the result of straightenTimes(), > 0 [s].
std::string straightenedText(double change);

/// Says why the arm cannot follow the set points; empty: it can. The times must increase and end within a million
/// seconds. The angles must lie in the joint's range, and the speeds must not exceed three times the speed limit.
std::string motionErrors(const std::vector<ArmSetPoint>& points, const ArmDescription& arm);

/// @throws InputError if there is no set point, for the reasons that motionErrors() gives, or if a joint cannot bear
/// the weight of links and payload at rest. `what`: source of the set points.
void requireMotion(const std::vector<ArmSetPoint>& points, const ArmDescription& arm, const std::string& what);

/// @throws InputError if the size or the sign of a joint's speeds is not that of the angles' rates.
void requireRates(const std::vector<ArmSetPoint>& points, const ArmDescription& arm, const std::string& what);

/// Checks the torques of a motion, without friction. Links and payload may need at most ArmJoint::torque_limit. With
/// the motor's inertia they may need at most the motor's torque limit.
class MotionLimits
{
public:
  /// `drives`: parameters of the arm's drives. @throws ParameterError for the reasons that ArmDynamics names.
  MotionLimits(const ArmDescription& arm, const std::vector<Parameters>& drives);

  void setPayload(const Payload& payload) noexcept { dynamics_.setPayload(payload); }

  /// Says which joint first exceeds a limit, and when, if angles follow cubics between set points; empty: no joint.
  std::string errors(const std::vector<ArmSetPoint>& points);

private:
  /// The limits of a joint, at its output.
  struct Joint
  {
    std::string name;
    double torque_limit{};   // largest torque of links and payload; 0: no limit [N.m]
    double motor_limit{};    // largest torque of the motor, seen at the output [N.m]
    double motor_inertia{};  // inertia of the motor, seen from the joint [kg.m^2]
  };

  std::string errorsAt(const std::vector<JointMotion>& motion, double before);

  ArmDynamics dynamics_;
  std::vector<Joint> joints_;
  std::vector<double> torques_;
};
}  // namespace hjt
