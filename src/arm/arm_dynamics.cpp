// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_dynamics.hpp"

#include <cmath>
#include <string>

#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
KDL::Vector vectorOf(const std::array<double, 3>& values)
{
  return { values[0], values[1], values[2] };
}

KDL::Joint jointOf(const ArmLink& link)
{
  return link.motion == LinkMotion::FIXED ?
             KDL::Joint(KDL::Joint::None) :
             KDL::Joint(vectorOf(link.origin), vectorOf(link.axis),
                        link.motion == LinkMotion::TURNS ? KDL::Joint::RotAxis : KDL::Joint::TransAxis);
}

KDL::RigidBodyInertia bodyOf(const Payload& payload)
{
  return KDL::RigidBodyInertia(payload.mass, vectorOf(payload.centre));
}

/// Chain of the arm's links, with the payload as the last segment.
KDL::Chain chainOf(const ArmDescription& arm)
{
  KDL::Chain chain;
  for (const ArmLink& link : arm.links)
  {
    const std::array<double, 9>& r = link.rotation;
    const std::array<double, 6>& i = link.inertia;
    chain.addSegment(KDL::Segment(
        jointOf(link),
        KDL::Frame(KDL::Rotation(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]), vectorOf(link.position)),
        KDL::RigidBodyInertia(link.mass, vectorOf(link.centre),
                              KDL::RotationalInertia(i[0], i[1], i[2], i[3], i[4], i[5]))));
  }
  if (chain.getNrOfJoints() != arm.joints.size())
  {
    throw ParameterError(arm.origin + ": the arm has " + std::to_string(arm.joints.size()) + " joints, but " +
                         std::to_string(chain.getNrOfJoints()) + " links that move");
  }
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), KDL::Frame::Identity(), bodyOf(arm.payload)));
  return chain;
}
}  // namespace

struct ArmDynamics::Solver
{
  explicit Solver(const ArmDescription& arm)
    : chain(chainOf(arm))
    , gravity(vectorOf(arm.gravity))
    , drag(arm.drag)
    , recursion(chain, gravity)
    , parameters(chain, gravity)
    , position(chain.getNrOfJoints())
    , velocity(chain.getNrOfJoints())
    , acceleration(chain.getNrOfJoints())
    , torque(chain.getNrOfJoints())
    , mass(chain.getNrOfJoints())
    , forces(chain.getNrOfSegments(), KDL::Wrench::Zero())
  {
  }

  /// Copies make new solvers, because KDL's solvers refer to the chain with which they were made.
  Solver(const Solver& other)
    : chain(other.chain)
    , gravity(other.gravity)
    , drag(other.drag)
    , recursion(chain, gravity)
    , parameters(chain, gravity)
    , position(other.position)
    , velocity(other.velocity)
    , acceleration(other.acceleration)
    , torque(other.torque)
    , mass(other.mass)
    , forces(other.forces)
  {
  }
  Solver& operator=(const Solver&) = delete;

  void setPositions(const std::vector<JointMotion>& motion) noexcept
  {
    for (unsigned i = 0; i < motion.size(); ++i)
    {
      position(i) = motion[i].position;
    }
  }

  /// Calls `visit` with each segment and the pose of the segment's end, from the base on. Returns the pose of the tip.
  template <class Visit>
  KDL::Frame walk(const Visit& visit) const
  {
    KDL::Frame pose = KDL::Frame::Identity();
    unsigned joint = 0;
    for (const KDL::Segment& segment : chain.segments)
    {
      const bool moves = segment.getJoint().getType() != KDL::Joint::None;
      pose = pose * segment.pose(moves ? position(joint) : 0.0);
      joint += moves ? 1 : 0;
      visit(segment, pose);
    }
    return pose;
  }

  /// Velocity of the tip [m/s].
  KDL::Vector tipVelocity() const
  {
    KDL::Frame pose = KDL::Frame::Identity();
    KDL::Twist twist = KDL::Twist::Zero();
    unsigned joint = 0;
    for (const KDL::Segment& segment : chain.segments)
    {
      const bool moves = segment.getJoint().getType() != KDL::Joint::None;
      const double angle = moves ? position(joint) : 0.0;
      const KDL::Frame next = pose * segment.pose(angle);
      twist = twist.RefPoint(next.p - pose.p) + pose.M * segment.twist(angle, moves ? velocity(joint) : 0.0);
      joint += moves ? 1 : 0;
      pose = next;
    }
    return twist.vel;
  }

  KDL::Chain chain;
  KDL::Vector gravity;
  double drag;  // force on the tip against the tip's motion [N]
  KDL::ChainIdSolver_RNE recursion;
  KDL::ChainDynParam parameters;
  KDL::JntArray position;
  KDL::JntArray velocity;
  KDL::JntArray acceleration;
  KDL::JntArray torque;
  KDL::JntSpaceInertiaMatrix mass;
  KDL::Wrenches forces;  // force and moment on each segment, in the segment's frame [N], [N.m]
};

ArmDynamics::ArmDynamics(const ArmDescription& arm) : solver_(std::make_unique<Solver>(arm)) {}

ArmDynamics::ArmDynamics(const ArmDynamics& other)
  : solver_(std::make_unique<Solver>(*other.solver_)), wrench_(other.wrench_)
{
}

ArmDynamics::~ArmDynamics() = default;
ArmDynamics::ArmDynamics(ArmDynamics&&) noexcept = default;

std::size_t ArmDynamics::joints() const noexcept
{
  return solver_->chain.getNrOfJoints();
}

double ArmDynamics::mass() const noexcept
{
  double mass = 0.0;
  for (const KDL::Segment& segment : solver_->chain.segments)
  {
    mass += segment.getInertia().getMass();
  }
  return mass;
}

void ArmDynamics::setPayload(const Payload& payload) noexcept
{
  solver_->chain.segments.back().setInertia(bodyOf(payload));
}

void ArmDynamics::torques(const std::vector<JointMotion>& motion, std::vector<double>& torques) noexcept
{
  Solver& solver = *solver_;
  solver.setPositions(motion);
  for (unsigned i = 0; i < motion.size(); ++i)
  {
    solver.velocity(i) = motion[i].velocity;
    solver.acceleration(i) = motion[i].acceleration;
  }
  KDL::Wrench wrench(vectorOf(wrench_.force), vectorOf(wrench_.moment));
  if (solver.drag != 0.0)
  {
    const KDL::Vector velocity = solver.tipVelocity();
    wrench.force -= solver.drag / std::hypot(velocity.Norm(), DRAG_SPEED) * velocity;
  }
  if (wrench != KDL::Wrench::Zero())
  {
    const KDL::Frame tip = solver.walk([](const KDL::Segment&, const KDL::Frame&) {});
    solver.forces.back() = tip.M.Inverse() * wrench;
  }
  else
  {
    solver.forces.back() = wrench;
  }
  solver.recursion.CartToJnt(solver.position, solver.velocity, solver.acceleration, solver.forces, solver.torque);
  for (unsigned i = 0; i < motion.size(); ++i)
  {
    torques[i] = solver.torque(i);
  }
}

void ArmDynamics::massMatrix(const std::vector<JointMotion>& motion, Eigen::MatrixXd& mass) noexcept
{
  Solver& solver = *solver_;
  solver.setPositions(motion);
  solver.parameters.JntToMass(solver.position, solver.mass);
  mass = solver.mass.data;
}

double ArmDynamics::potentialEnergy(const std::vector<JointMotion>& motion) noexcept
{
  Solver& solver = *solver_;
  solver.setPositions(motion);
  double energy = 0.0;
  solver.walk(
      [&](const KDL::Segment& segment, const KDL::Frame& pose)
      {
        const KDL::RigidBodyInertia& body = segment.getInertia();
        energy -= body.getMass() * KDL::dot(solver.gravity, pose * body.getCOG());
      });
  return energy;
}

ToolPose ArmDynamics::toolPose(const std::vector<JointMotion>& motion) noexcept
{
  Solver& solver = *solver_;
  solver.setPositions(motion);
  const KDL::Frame pose = solver.walk([](const KDL::Segment&, const KDL::Frame&) {});
  ToolPose tool;
  tool.position = { pose.p.x(), pose.p.y(), pose.p.z() };
  pose.M.GetQuaternion(tool.orientation[0], tool.orientation[1], tool.orientation[2], tool.orientation[3]);
  return tool;
}
}  // namespace hjt
