// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "arm/arm_dynamics.hpp"

namespace hjt
{
/// Torques at an arm's joints of its links, or of unit payloads, of unit gravity and of a unit drag: each from one walk
/// along the links, as ArmDynamics to the rounding and in less time. After construction nothing throws or allocates.
class UnitLoads
{
public:
  static constexpr int COLUMNS = 10;
  using Torques = Eigen::Matrix<double, COLUMNS, 1>;  ///< of a joint

  explicit UnitLoads(const ArmDescription& arm);

  double linksMass() const;  ///< without the payload [kg]

  /// Of mass and moments, of gravity along each axis of the base's frame, of a force against the tip's motion, and of
  /// forces on the tip along two directions across gravity, at each joint, by column [N.m/kg], [N.m/(kg.m)],
  /// [N.m/(m/s^2)], [N.m/N], [N.m/N].
  void torques(const std::vector<JointMotion>& motion, Eigen::MatrixXd& columns) noexcept;

  /// Of links, payload and drag themselves, at each joint [N.m].
  void own(const std::vector<JointMotion>& motion, std::vector<double>& torques) noexcept;

  void setPayload(const Payload& payload) noexcept { payload_ = payload; }  ///< in place of the description's

private:
  /// In the frames of an ArmLink.
  struct Link
  {
    LinkMotion motion{};
    Eigen::Vector3d axis;
    Eigen::Vector3d origin;
    Eigen::Vector3d position;
    Eigen::Matrix3d rotation;
    double mass{};
    Eigen::Vector3d centre;
    Eigen::Matrix3d inertia;
  };

  /// In the base's frame.
  struct Joint
  {
    bool turns{};
    Eigen::Vector3d axis;
    Eigen::Vector3d origin;
    double mass{};           // that it carries [kg]
    Eigen::Vector3d moment;  // of it [kg.m], or of the force on it [N.m], about the base
    Eigen::Vector3d force;   // on it [N]

    /// Torque, or force along the axis, that a force at a place and a moment take.
    double effort(const Eigen::Vector3d& force, const Eigen::Vector3d& place, const Eigen::Vector3d& couple) const
    {
      return axis.dot(turns ? Eigen::Vector3d(couple + (place - origin).cross(force)) : force);
    }
  };

  /// Of a link's frame, in the base's frame.
  struct Motion
  {
    Eigen::Matrix3d orientation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      // of the place [m/s]
    Eigen::Vector3d speed = Eigen::Vector3d::Zero();         // of turning [rad/s]
    Eigen::Vector3d turning = Eigen::Vector3d::Zero();       // its derivative [rad/s^2]
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  // of the place [m/s^2]

    /// Acceleration of what lies at `arm` from the place, less that of the place.
    Eigen::Vector3d swing(const Eigen::Vector3d& arm) const
    {
      return turning.cross(arm) + speed.cross(speed.cross(arm));
    }
  };

  static void follow(const Link& link, const JointMotion& motion, Motion& at);
  template <class Visit>
  Motion walk(const std::vector<JointMotion>& motion, const Visit& visit);

  std::vector<Link> links_;
  std::vector<Joint> joints_;  // where the last walk found them
  Payload payload_;
  Eigen::Vector3d gravity_;
  Eigen::Matrix<double, 3, 2> across_;  // directions across gravity, where no payload weighs
  double drag_;
};
}  // namespace hjt
