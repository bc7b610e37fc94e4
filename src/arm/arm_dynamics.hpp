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
/// Motion of one joint of an arm.
struct JointMotion
{
  double position{};      ///< [rad]
  double velocity{};      ///< [rad/s]
  double acceleration{};  ///< [rad/s^2]
};

/// Force [N] and moment [N.m] on the tip, in the frame of the base.
struct ArmWrench
{
  std::array<double, 3> force{};
  std::array<double, 3> moment{};
};

/// Of the tip in the frame of the base: position [m]; orientation as a unit quaternion x, y, z, w [-].
struct ToolPose
{
  std::array<double, 3> position{};
  std::array<double, 4> orientation{};
};

inline constexpr double DRAG_SPEED = 0.01;  ///< of the tip, above which a drag has nearly all its force [m/s]

/// Rigid-body dynamics of an arm: weight, inertia, Coriolis and coupling of all links and the payload, by KDL's
/// recursive Newton-Euler. Links alone: the motors' inertia is that of the drives. After construction nothing but a
/// copy throws or allocates.
class ArmDynamics
{
public:
  /// @throws ParameterError if not as many of the links move as the arm has joints.
  explicit ArmDynamics(const ArmDescription& arm);
  ~ArmDynamics();
  ArmDynamics(const ArmDynamics& other);
  ArmDynamics(ArmDynamics&&) noexcept;

  std::size_t joints() const noexcept;
  double mass() const noexcept;  ///< of the links from the first to the tip, and the payload [kg]

  /// `torques` at the output of each joint that make the motion, > 0 resists positive motion [N.m]. Both have an entry
  /// for each joint.
  void torques(const std::vector<JointMotion>& motion, std::vector<double>& torques) noexcept;

  /// Force [N] and moment about the tip [N.m] on the tip from outside, in the frame of the base; counts in `torques`.
  void setWrench(const ArmWrench& wrench) noexcept { wrench_ = wrench; }

  void setPayload(const Payload& payload) noexcept;  ///< in place of the description's

  /// Inertia of links and payload by joints, symmetric [kg.m^2]; `mass`: of the joints' size.
  void massMatrix(const std::vector<JointMotion>& motion, Eigen::MatrixXd& mass) noexcept;
  double potentialEnergy(const std::vector<JointMotion>& motion) noexcept;  ///< of weight [J]
  ToolPose toolPose(const std::vector<JointMotion>& motion) noexcept;

private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
  ArmWrench wrench_;
};
}  // namespace hjt
