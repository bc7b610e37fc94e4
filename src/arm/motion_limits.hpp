// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "arm/arm_controller.hpp"
#include "arm/arm_motion.hpp"
#include "base/number_text.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Which accelerations an arm can follow: at no set point may links and payload need more than ArmJoint::torque_limit,
/// nor with the motor's own inertia more than the motor has. Friction is left out.
class MotionLimits
{
public:
  /// `drives`: of the arm's joints. @throws ParameterError as ArmDynamics.
  MotionLimits(const ArmDescription& arm, const std::vector<Parameters>& drives)
    : dynamics_(arm), torques_(drives.size())
  {
    for (std::size_t i = 0; i < drives.size(); ++i)
    {
      joints_.push_back({ arm.joints[i].name, arm.joints[i].torque_limit,
                          nominalRatio(drives[i].gear) * drives[i].motor.torque_limit,
                          ArmController::motorInertia(drives[i]) });
    }
  }

  void setPayload(const Payload& payload) noexcept { dynamics_.setPayload(payload); }

  /// Of a motion by cubics; empty: nothing. The first joint beyond and when.
  std::string errors(const std::vector<ArmSetPoint>& points)
  {
    std::vector<JointMotion> motion(joints_.size());
    for (std::size_t k = 1; k < points.size(); ++k)
    {
      ArmMotion piece({ points[k - 1], points[k] }, ArmAccelerations::OF_CUBICS);
      const double length = points[k].time - points[k - 1].time;
      // The acceleration of a cubic is greatest at its ends, which belong to the set points' neighbours too.
      for (const double share : { 1e-6, 0.5, 1.0 - 1e-6 })
      {
        piece.at(points[k - 1].time + share * length, motion);
        if (std::string error = errorsAt(motion, points[k].time); !error.empty())
        {
          return error;
        }
      }
    }
    return {};
  }

private:
  /// Of a joint at its output.
  struct Joint
  {
    std::string name;
    double torque_limit{};   // 0: none [N.m]
    double motor_limit{};    // [N.m]
    double motor_inertia{};  // [kg.m^2]
  };

  std::string errorsAt(const std::vector<JointMotion>& motion, double before)
  {
    dynamics_.torques(motion, torques_);
    for (std::size_t i = 0; i < joints_.size(); ++i)
    {
      const Joint& joint = joints_[i];
      const double motor = std::abs(torques_[i] + joint.motor_inertia * motion[i].acceleration);
      // Written so that NaN fails.
      const bool links_can = joint.torque_limit == 0.0 || std::abs(torques_[i]) <= joint.torque_limit;
      if (!links_can || !(motor <= joint.motor_limit))
      {
        return joint.name + " would need " + roundedText(links_can ? motor : std::abs(torques_[i]), 3) +
               (links_can ? " N.m of its motor" : " N.m") + " before " + roundedText(before, 4) + " s, at " +
               roundedText(motion[i].acceleration, 3) + " rad/s^2; " + (links_can ? "it has " : "its limit is ") +
               roundedText(links_can ? joint.motor_limit : joint.torque_limit, 4);
      }
    }
    return {};
  }

  ArmDynamics dynamics_;
  std::vector<Joint> joints_;
  std::vector<double> torques_;
};
}  // namespace hjt
