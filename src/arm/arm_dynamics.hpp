// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "arm/arm_description.hpp"

namespace hjt
{
/// Angle, speed and acceleration of one joint of an arm.
struct JointMotion
{
  double position{};      ///< angle of the joint [rad]
  double velocity{};      ///< speed of the joint [rad/s]
  double acceleration{};  ///< acceleration of the joint [rad/s^2]
};

/// Force [N] and moment [N.m] on the tip, in the frame of the base.
struct ArmWrench
{
  std::array<double, 3> force{};
  std::array<double, 3> moment{};
};

/// Pose of the tip in the frame of the base: position [m] and orientation as a unit quaternion x, y, z, w [-].
struct ToolPose
{
  std::array<double, 3> position{};
  std::array<double, 4> orientation{};
};

inline constexpr double DRAG_SPEED = 0.01;  ///< speed of the tip above which the drag has nearly its full force [m/s]

/// Rigid-body dynamics of an arm by KDL's recursive Newton-Euler: weight, inertia, Coriolis forces and coupling of all
/// links and the payload. This model has no inertia of the motors, because the model of each drive contains the inertia
/// of its motor. After construction only a copy throws or allocates.
class ArmDynamics
{
public:
  /// @throws ParameterError if the number of links that move is not that of the arm's joints.
  explicit ArmDynamics(const ArmDescription& arm);
  ~ArmDynamics();
  ArmDynamics(const ArmDynamics& other);
  ArmDynamics(ArmDynamics&&) noexcept;

  std::size_t joints() const noexcept;
  double mass() const noexcept;  ///< mass of all links and of the payload [kg]

  /// Computes the load [N.m] at the output of each joint in this motion. A positive load resists positive motion.
  /// `motion` and `torques` have an entry for each joint.
  void torques(const std::vector<JointMotion>& motion, std::vector<double>& torques) noexcept;

  /// Sets the force [N] and the moment about the tip [N.m] that act on the tip from outside, in the frame of the base.
  /// torques() contains the effect of force and moment from then on.
  void setWrench(const ArmWrench& wrench) noexcept { wrench_ = wrench; }

  void setPayload(const Payload& payload) noexcept;  ///< replaces the payload of the arm's description

  /// Computes the symmetric mass matrix of links and payload [kg.m^2]. Row and column i are those of joint i.
  void massMatrix(const std::vector<JointMotion>& motion, Eigen::MatrixXd& mass) noexcept;
  double potentialEnergy(const std::vector<JointMotion>& motion) noexcept;  ///< potential energy in gravity [J]
  ToolPose toolPose(const std::vector<JointMotion>& motion) noexcept;

private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
  ArmWrench wrench_;
};
}  // namespace hjt
