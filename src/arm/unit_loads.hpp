// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "arm/arm_dynamics.hpp"

namespace hjt
{
/// Torques at an arm's joints: those of its own links, or those of unit payloads, unit gravity and a unit drag. Each
/// set of torques takes one walk along the links, less time than with ArmDynamics, and differs from ArmDynamics by
/// rounding only. After construction nothing throws or allocates.
class UnitLoads
{
public:
  static constexpr int COLUMNS = 10;
  using Torques = Eigen::Matrix<double, COLUMNS, 1>;  ///< torques of one joint by unit loads

  explicit UnitLoads(const ArmDescription& arm);

  double linksMass() const;  ///< mass of the links without the payload [kg]

  /// Gives the torques at each joint, a row, of unit loads. The columns are: mass [N.m/kg] and three moments
  /// [N.m/(kg.m)] of a payload, gravity along each axis of the base's frame [N.m/(m/s^2)], a force against the tip's
  /// motion [N.m/N], and forces on the tip along two directions across gravity [N.m/N].
  void torques(const std::vector<JointMotion>& motion, Eigen::MatrixXd& columns) noexcept;

  /// Gives the torques of links, payload and drag at each joint [N.m].
  void own(const std::vector<JointMotion>& motion, std::vector<double>& torques) noexcept;

  void setPayload(const Payload& payload) noexcept { payload_ = payload; }  ///< replaces the payload of the description

private:
  /// A link, in the frames of an ArmLink.
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

  /// A joint and what it carries, in the base's frame.
  struct Joint
  {
    bool turns{};
    Eigen::Vector3d axis;
    Eigen::Vector3d origin;
    double mass{};           // mass that it carries [kg]
    Eigen::Vector3d moment;  // moment of that mass [kg.m], or of the force on it [N.m], about the base
    Eigen::Vector3d force;   // force on that mass [N]

    /// Torque, or force along the axis, of a joint that bears a force at a place and a moment.
    double effort(const Eigen::Vector3d& force, const Eigen::Vector3d& place, const Eigen::Vector3d& couple) const
    {
      return axis.dot(turns ? Eigen::Vector3d(couple + (place - origin).cross(force)) : force);
    }
  };

  /// Motion of a link's frame, in the base's frame.
  struct Motion
  {
    Eigen::Matrix3d orientation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      // velocity of the place [m/s]
    Eigen::Vector3d speed = Eigen::Vector3d::Zero();         // angular velocity [rad/s]
    Eigen::Vector3d turning = Eigen::Vector3d::Zero();       // angular acceleration [rad/s^2]
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  // acceleration of the place [m/s^2]

    /// Acceleration of a point at `arm` from the place, less that of the place.
    Eigen::Vector3d swing(const Eigen::Vector3d& arm) const
    {
      return turning.cross(arm) + speed.cross(speed.cross(arm));
    }
  };

  static void follow(const Link& link, const JointMotion& motion, Motion& at);
  template <class Visit>
  Motion walk(const std::vector<JointMotion>& motion, const Visit& visit);

  std::vector<Link> links_;
  std::vector<Joint> joints_;  // joints as the last walk found them
  Payload payload_;
  Eigen::Vector3d gravity_;
  Eigen::Matrix<double, 3, 2> across_;  // directions across gravity, where no payload weighs
  double drag_;
};
}  // namespace hjt
