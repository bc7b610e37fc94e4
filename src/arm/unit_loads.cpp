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
  : joints_(arm.joints.size()), payload_(arm.payload), gravity_(vectorOf(arm.gravity)), drag_(arm.drag)
{
  const Eigen::Vector3d down = gravity_.isZero() ? Eigen::Vector3d(Eigen::Vector3d::UnitZ()) : gravity_;
  across_.col(0) = down.unitOrthogonal();
  across_.col(1) = down.cross(across_.col(0)).normalized();
  for (const ArmLink& link : arm.links)
  {
    const std::array<double, 6>& i = link.inertia;
    Eigen::Matrix3d inertia;
    inertia << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
    links_.push_back({ link.motion, vectorOf(link.axis), vectorOf(link.origin), vectorOf(link.position),
                       Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(link.rotation.data()), link.mass,
                       vectorOf(link.centre), inertia });
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

/// Changes `at` from the motion of the link before to that of `link`. `motion`: motion of the joint before `link`.
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

/// Computes the motion of the tip and the place of each joint. Calls `visit` with the motion of each body (links, then
/// payload) and with the number of joints between base and body. Returns the motion of the tip.
template <class Visit>
UnitLoads::Motion UnitLoads::walk(const std::vector<JointMotion>& motion, const Visit& visit)
{
  Motion at;
  std::size_t joint = 0;
  for (const Link& link : links_)
  {
    const bool moves = link.motion != LinkMotion::FIXED;
    if (moves)
    {
      joints_[joint] = {
        link.motion == LinkMotion::TURNS, at.orientation * link.axis, at.place + at.orientation * link.origin, 0.0,
        Eigen::Vector3d::Zero(),          Eigen::Vector3d::Zero()
      };
    }
    follow(link, moves ? motion[joint] : JointMotion{}, at);
    joint += moves ? 1 : 0;
    visit(at, joint, link.mass, link.centre, link.inertia);
  }
  visit(at, joint, payload_.mass, vectorOf(payload_.centre), Eigen::Matrix3d::Zero());
  return at;
}

void UnitLoads::own(const std::vector<JointMotion>& motion, std::vector<double>& torques) noexcept
{
  const auto bear = [&](const Motion& at, std::size_t joints, double mass, const Eigen::Vector3d& centre,
                        const Eigen::Matrix3d& inertia)
  {
    if (joints > 0)
    {
      const Eigen::Vector3d arm = at.orientation * centre;
      const Eigen::Vector3d force = mass * (at.acceleration + at.swing(arm) - gravity_);
      const Eigen::Matrix3d about = at.orientation * inertia * at.orientation.transpose();
      joints_[joints - 1].force += force;
      joints_[joints - 1].moment +=
          (at.place + arm).cross(force) + about * at.turning + at.speed.cross(about * at.speed);
    }
  };
  const Motion tip = walk(motion, bear);
  Eigen::Vector3d force = drag_ / std::hypot(tip.velocity.norm(), DRAG_SPEED) * tip.velocity;
  Eigen::Vector3d moment = tip.place.cross(force);
  for (std::size_t i = joints_.size(); i-- > 0;)
  {
    force += joints_[i].force;
    moment += joints_[i].moment;
    torques[i] = joints_[i].effort(force, Eigen::Vector3d::Zero(), moment);
  }
}

void UnitLoads::torques(const std::vector<JointMotion>& motion, Eigen::MatrixXd& columns) noexcept
{
  const auto carry = [&](const Motion& at, std::size_t joints, double mass, const Eigen::Vector3d& centre,
                         const Eigen::Matrix3d& /*inertia*/)
  {
    const Eigen::Vector3d moment = mass * (at.place + at.orientation * centre);
    for (std::size_t i = 0; i < joints; ++i)
    {
      joints_[i].mass += mass;
      joints_[i].moment += moment;
    }
  };
  const Motion tip = walk(motion, carry);
  const Eigen::Vector3d of_mass = tip.acceleration - gravity_;
  const Eigen::Vector3d along = tip.velocity / std::hypot(tip.velocity.norm(), DRAG_SPEED);
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    const Joint& joint = joints_[i];
    const auto row = static_cast<Eigen::Index>(i);
    columns(row, 0) = joint.effort(of_mass, tip.place, Eigen::Vector3d::Zero());
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
      // The loads by a payload of mass 1 at the distance `arm` from the tip have a part that is linear in `arm`. This
      // part is the load by a unit moment. The quadratic part is that of the payload's inertia.
      const Eigen::Vector3d arm = tip.orientation.col(axis);
      columns(row, 1 + axis) = joint.effort(tip.swing(arm), tip.place, arm.cross(of_mass));
      // Load by the mass after the joint in a unit gravity along `axis`: a torque if the joint turns, else a force.
      const Eigen::Vector3d up = -Eigen::Vector3d::Unit(axis);
      columns(row, 4 + axis) = joint.turns ? joint.axis.dot((joint.moment - joint.mass * joint.origin).cross(up)) :
                                             joint.mass * joint.axis.dot(up);
    }
    columns(row, 7) = joint.effort(along, tip.place, Eigen::Vector3d::Zero());
    for (Eigen::Index way = 0; way < 2; ++way)
    {
      columns(row, 8 + way) = -joint.effort(across_.col(way), tip.place, Eigen::Vector3d::Zero());
    }
  }
}
}  // namespace hjt
