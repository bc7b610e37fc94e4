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
/// Reads set points from a CSV file or from a program, FILE.yaml. The CSV file is a controller's recording with the
/// columns `timestamp` or `time` [s], `target_q_0` and so on [rad], optional `target_qd_0` and `target_qdd_0` and so
/// on, or a motion that `joint_twin checkup` wrote. @throws InputError, ParameterError.
std::vector<ArmSetPoint> readSetPoints(const std::string& path, const ArmDescription& arm);

/// Computes rates that are not given from differences of the angles. At either end of the motion a joint is at rest,
/// unless it is too fast to start or stop within a row at 10 rad/s^2: then the motion is a piece of a longer one.
void fillRates(std::vector<ArmSetPoint>& points, bool has_velocity, bool has_acceleration);

/// Mends the times of set points whose stamps jitter, as of rows that were stamped after they were sent: each step
/// becomes the time in which the joints go from row to row at their speeds. The times stay where the speeds are not the
/// rates of the angles, or the stamps fit them. Returns the largest change of a step, 0 without a change [s].
double straightenTimes(std::vector<ArmSetPoint>& points);

/// Message for the user that straightenTimes() changed the times. `change`: its result, > 0 [s].
std::string straightenedText(double change);

/// Says why no arm can follow the set points; empty if nothing is wrong. The times must increase and end within a
/// million seconds, the angles must be in the joint's range, and the speeds at most three times the joint's limit.
std::string motionErrors(const std::vector<ArmSetPoint>& points, const ArmDescription& arm);

/// @throws InputError if there is no set point, with motionErrors, or if a joint cannot bear the weight of links and
/// payload at rest. `what` names the source of the set points.
void requireMotion(const std::vector<ArmSetPoint>& points, const ArmDescription& arm, const std::string& what);

/// @throws InputError if the size or the sign of a joint's speeds is not that of the angles' rates.
void requireRates(const std::vector<ArmSetPoint>& points, const ArmDescription& arm, const std::string& what);

/// Checks the accelerations of a motion: links and payload may need at most ArmJoint::torque_limit, and together with
/// the motor's own inertia at most the torque of the motor. Friction is neglected.
class MotionLimits
{
public:
  /// `drives`: parameters of the arm's drives. @throws ParameterError for the reasons that ArmDynamics names.
  MotionLimits(const ArmDescription& arm, const std::vector<Parameters>& drives);

  void setPayload(const Payload& payload) noexcept { dynamics_.setPayload(payload); }

  /// Names the first joint that would exceed a limit, and the time, in a motion by cubics; empty if none would.
  std::string errors(const std::vector<ArmSetPoint>& points);

private:
  /// Limits of a joint at its output.
  struct Joint
  {
    std::string name;
    double torque_limit{};   // largest torque of links and payload; 0 without a limit [N.m]
    double motor_limit{};    // largest torque of the motor, seen at the output [N.m]
    double motor_inertia{};  // [kg.m^2]
  };

  std::string errorsAt(const std::vector<JointMotion>& motion, double before);

  ArmDynamics dynamics_;
  std::vector<Joint> joints_;
  std::vector<double> torques_;
};
}  // namespace hjt
