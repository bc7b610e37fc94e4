// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "arm/arm_dynamics.hpp"

namespace hjt
{
/// Loads of an arm's joints, either by links, payload and drag, or by unit payloads, unit gravity and unit forces on
/// the tip. Each function walks once along the links and takes less time than ArmDynamics. The results differ from
/// those of ArmDynamics only by rounding. After construction nothing throws or allocates.
class UnitLoads
{
public:
  static constexpr int COLUMNS = 10;
  using Torques = Eigen::Matrix<double, COLUMNS, 1>;  ///< torques at one joint by each unit load, as in torques()

  explicit UnitLoads(const ArmDescription& arm);

  double linksMass() const;  ///< mass of the links without the payload [kg]

  /// Computes the torques of unit loads at each joint. Each row is a joint. The columns are: mass [N.m/kg] and three
  /// moments [N.m/(kg.m)] of a payload, gravity along each axis of the base's frame [N.m/(m/s^2)], a force against the
  /// tip's motion [N.m/N], and forces on the tip along two directions across gravity [N.m/N].
  void torques(const std::vector<JointMotion>& motion, Eigen::MatrixXd& columns) noexcept;

  /// Computes the torques of links, payload and drag at each joint [N.m].
  void own(const std::vector<JointMotion>& motion, std::vector<double>& torques) noexcept;

  void setPayload(const Payload& payload) noexcept { payload_ = payload; }  ///< replaces the payload of the description

private:
  /// A link of the arm, with fields as in ArmLink.
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

  /// A joint in the frame of the base, and the mass of all links and the payload after the joint.
  struct Joint
  {
    bool turns{};
    Eigen::Vector3d axis;
    Eigen::Vector3d origin;
    double mass{};           // mass after the joint [kg]
    Eigen::Vector3d moment;  // first moment of this mass about the base [kg.m], or moment of the force on it [N.m]
    Eigen::Vector3d force;   // force on this mass [N]

    /// Torque about the axis of a joint that turns [N.m], or force along the axis of a joint that slides [N], under a
    /// force `force` at `place` and a moment `couple`.
    double effort(const Eigen::Vector3d& force, const Eigen::Vector3d& place, const Eigen::Vector3d& couple) const
    {
      return axis.dot(turns ? Eigen::Vector3d(couple + (place - origin).cross(force)) : force);
    }
  };

  /// Pose and motion of a link's frame, in the frame of the base.
  struct Motion
  {
    Eigen::Matrix3d orientation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      // velocity of `place` [m/s]
    Eigen::Vector3d speed = Eigen::Vector3d::Zero();         // angular velocity [rad/s]
    Eigen::Vector3d turning = Eigen::Vector3d::Zero();       // angular acceleration [rad/s^2]
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  // acceleration of `place` [m/s^2]

    /// Acceleration of a point at the distance `arm` from `place`, minus the acceleration of `place` [m/s^2].
    Eigen::Vector3d swing(const Eigen::Vector3d& arm) const
    {
      return turning.cross(arm) + speed.cross(speed.cross(arm));
    }
  };

  static void follow(const Link& link, const JointMotion& motion, Motion& at);
  template <class Visit>
  Motion walk(const std::vector<JointMotion>& motion, const Visit& visit);

  std::vector<Link> links_;
  std::vector<Joint> joints_;  // joints in the pose of the last walk along the links
  Payload payload_;
  Eigen::Vector3d gravity_;
  Eigen::Matrix<double, 3, 2> across_;  // two directions across gravity, in which a payload has no weight
  double drag_;
};
}  // namespace hjt
