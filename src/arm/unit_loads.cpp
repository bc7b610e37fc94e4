// SPDX-License-Identifier: BSD-3-Clause
#include "arm/unit_loads.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace hjt
{
namespace
{
Eigen::Vector3d vectorOf(const std::array<double, 3>& values)
{
  return { values[0], values[1], values[2] };
}
}  // namespace

UnitLoads::UnitLoads(const ArmDescription& arm)
  : joints_(arm.joints.size()), payload_(arm.payload), gravity_(vectorOf(arm.gravity))
{
  for (const ArmLink& link : arm.links)
  {
    links_.push_back({ link.motion, vectorOf(link.axis), vectorOf(link.origin), vectorOf(link.position),
                       Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(link.rotation.data()), link.mass,
                       vectorOf(link.centre) });
  }
}

double UnitLoads::linksMass() const
{
  double mass = 0.0;
  for (const Link& link : links_)
  {
    mass += link.mass;
  }
  return mass;
}

/// From the frame of the link before to that of `link`.
void UnitLoads::follow(const Link& link, const JointMotion& motion, Motion& at)
{
  const Eigen::Vector3d axis = at.orientation * link.axis;
  if (link.motion != LinkMotion::TURNS)
  {
    const bool slides = link.motion == LinkMotion::SLIDES;
    const Eigen::Vector3d arm = at.orientation * link.position + (slides ? motion.position : 0.0) * axis;
    at.velocity += at.speed.cross(arm);
    at.acceleration += at.swing(arm);
    if (slides)
    {
      at.velocity += motion.velocity * axis;
      at.acceleration += 2.0 * motion.velocity * at.speed.cross(axis) + motion.acceleration * axis;
    }
    at.place += arm;
    at.orientation *= link.rotation;
    return;
  }
  const Eigen::Vector3d origin = at.orientation * link.origin;
  at.velocity += at.speed.cross(origin);
  at.acceleration += at.swing(origin);
  at.turning += motion.acceleration * axis + motion.velocity * at.speed.cross(axis);
  at.speed += motion.velocity * axis;
  at.orientation *= Eigen::AngleAxisd(motion.position, link.axis).toRotationMatrix();
  const Eigen::Vector3d arm = at.orientation * (link.position - link.origin);
  at.velocity += at.speed.cross(arm);
  at.acceleration += at.swing(arm);
  at.place += origin + arm;
  at.orientation *= link.rotation;
}

/// The tip's motion; leaves in each joint where it is and what it carries.
UnitLoads::Motion UnitLoads::walk(const std::vector<JointMotion>& motion)
{
  Motion at;
  std::size_t joint = 0;
  const auto carry = [&](double mass, const Eigen::Vector3d& centre)
  {
    const Eigen::Vector3d moment = mass * (at.place + at.orientation * centre);
    for (std::size_t i = 0; i < joint; ++i)
    {
      joints_[i].mass += mass;
      joints_[i].moment += moment;
    }
  };
  for (const Link& link : links_)
  {
    const bool moves = link.motion != LinkMotion::FIXED;
    if (moves)
    {
      joints_[joint] = { link.motion == LinkMotion::TURNS, at.orientation * link.axis,
                         at.place + at.orientation * link.origin, 0.0, Eigen::Vector3d::Zero() };
    }
    follow(link, moves ? motion[joint] : JointMotion{}, at);
    joint += moves ? 1 : 0;
    carry(link.mass, link.centre);
  }
  carry(payload_.mass, vectorOf(payload_.centre));
  return at;
}

void UnitLoads::torques(const std::vector<JointMotion>& motion, Eigen::MatrixXd& columns)
{
  const Motion tip = walk(motion);
  const Eigen::Vector3d of_mass = tip.acceleration - gravity_;
  const Eigen::Vector3d along = tip.velocity / std::hypot(tip.velocity.norm(), DRAG_SPEED);
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    const Joint& joint = joints_[i];
    const auto row = static_cast<Eigen::Index>(i);
    columns(row, 0) = joint.effort(of_mass, tip.place, Eigen::Vector3d::Zero());
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
      // Of a mass at the end of this arm what is linear in it; its inertia is quadratic.
      const Eigen::Vector3d arm = tip.orientation.col(axis);
      columns(row, 1 + axis) = joint.effort(tip.swing(arm), tip.place, arm.cross(of_mass));
      // All that it carries hangs from its centre: moments about the joint, forces that hold it.
      const Eigen::Vector3d up = -Eigen::Vector3d::Unit(axis);
      columns(row, 4 + axis) = joint.turns ? joint.axis.dot((joint.moment - joint.mass * joint.origin).cross(up)) :
                                             joint.mass * joint.axis.dot(up);
    }
    columns(row, 7) = joint.effort(along, tip.place, Eigen::Vector3d::Zero());
  }
}
}  // namespace hjt
