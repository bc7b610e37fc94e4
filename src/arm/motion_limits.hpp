// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_motion.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
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
