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
/// Set points of a CSV file: those of a controller's recording (`timestamp` or `time` [s], `target_q_0` ... [rad] and,
/// if there, `target_qd_0` ..., `target_qdd_0` ...), or a motion as `joint_twin checkup` writes it; or a program
/// (readArmProgram), FILE.yaml. @throws InputError, ParameterError.
std::vector<ArmSetPoint> readSetPoints(const std::string& path, const ArmDescription& arm);

/// Rates that are not given, by differences of the angles. At either end a joint is at rest, unless its speed is more
/// than 10 rad/s^2 make in the row beside it: there the motion is a piece of a longer one.
void fillRates(std::vector<ArmSetPoint>& points, bool has_velocity, bool has_acceleration);

/// Times of set points whose stamps jitter against their angles and speeds, as where rows were stamped after they were
/// sent: each step becomes the one in which the joints go from row to row at their speeds. Left alone where the speeds
/// are not the angles' rates, or the stamps go with them. Returns the largest change of a step; 0: none [s].
double straightenTimes(std::vector<ArmSetPoint>& points);

/// Remark for the user on such a change, above 0 [s].
std::string straightenedText(double change);

/// What of it no arm can be told, by whichever way it comes; empty: nothing. The time has to go on, for a million
/// seconds at most; angles lie within the joint's range, and speeds within three times its greatest.
std::string motionErrors(const std::vector<ArmSetPoint>& points, const ArmDescription& arm);

/// @throws InputError if there is none, with motionErrors, or where a joint cannot bear the weight of links and payload
/// at rest. `what`: they are of.
void requireMotion(const std::vector<ArmSetPoint>& points, const ArmDescription& arm, const std::string& what);

/// @throws InputError if a joint's speeds are not the angles' rates by size and sign.
void requireRates(const std::vector<ArmSetPoint>& points, const ArmDescription& arm, const std::string& what);

/// Which accelerations an arm can follow: at no set point may links and payload need more than ArmJoint::torque_limit,
/// nor with the motor's own inertia more than the motor has. Friction is left out.
class MotionLimits
{
public:
  /// `drives`: of the arm's joints. @throws ParameterError as ArmDynamics.
  MotionLimits(const ArmDescription& arm, const std::vector<Parameters>& drives);

  void setPayload(const Payload& payload) noexcept { dynamics_.setPayload(payload); }

  /// Of a motion by cubics; empty: nothing. The first joint beyond and when.
  std::string errors(const std::vector<ArmSetPoint>& points);

private:
  /// Of a joint at its output.
  struct Joint
  {
    std::string name;
    double torque_limit{};   // 0: none [N.m]
    double motor_limit{};    // [N.m]
    double motor_inertia{};  // [kg.m^2]
  };

  std::string errorsAt(const std::vector<JointMotion>& motion, double before);

  ArmDynamics dynamics_;
  std::vector<Joint> joints_;
  std::vector<double> torques_;
};
}  // namespace hjt
