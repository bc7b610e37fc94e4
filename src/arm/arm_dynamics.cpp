// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_dynamics.hpp"

#include <kdl/chain.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
KDL::Vector vectorOf(const std::array<double, 3>& values)
{
  return { values[0], values[1], values[2] };
}

KDL::Chain chainOf(const ArmDescription& arm)
{
  KDL::Tree tree;
  if (!kdl_parser::treeFromString(arm.urdf, tree))
  {
    throw ParameterError(arm.origin + ": its URDF cannot be read");
  }
  KDL::Chain chain;
  if (!tree.getChain(arm.base, arm.tip, chain))
  {
    throw ParameterError(arm.origin + ": its URDF has no chain of links from '" + arm.base + "' to '" + arm.tip + "'");
  }
  std::size_t found = 0;
  for (const KDL::Segment& segment : chain.segments)
  {
    const KDL::Joint& joint = segment.getJoint();
    if (joint.getType() == KDL::Joint::None)
    {
      continue;
    }
    if (found >= arm.joints.size() || joint.getName() != arm.joints[found].name)
    {
      throw ParameterError(arm.origin + ": joint " + std::to_string(found) + " of the URDF's chain is '" +
                           joint.getName() + "', not '" +
                           (found < arm.joints.size() ? arm.joints[found].name : std::string("none")) + "'");
    }
    ++found;
  }
  if (found < arm.joints.size())
  {
    throw ParameterError(arm.origin + ": the URDF's chain has no joint '" + arm.joints[found].name + "'");
  }
  const KDL::RigidBodyInertia payload(arm.payload.mass, vectorOf(arm.payload.centre));
  chain.addSegment(
      KDL::Segment("payload", KDL::Joint("payload_fixed", KDL::Joint::None), KDL::Frame::Identity(), payload));
  return chain;
}
}  // namespace

struct ArmDynamics::Solver
{
  explicit Solver(const ArmDescription& arm)
    : chain(chainOf(arm))
    , recursion(chain, vectorOf(arm.gravity))
    , position(chain.getNrOfJoints())
    , velocity(chain.getNrOfJoints())
    , acceleration(chain.getNrOfJoints())
    , torque(chain.getNrOfJoints())
    , no_forces(chain.getNrOfSegments(), KDL::Wrench::Zero())
  {
  }

  KDL::Chain chain;
  KDL::ChainIdSolver_RNE recursion;
  KDL::JntArray position;
  KDL::JntArray velocity;
  KDL::JntArray acceleration;
  KDL::JntArray torque;
  KDL::Wrenches no_forces;
};

ArmDynamics::ArmDynamics(const ArmDescription& arm) : solver_(std::make_unique<Solver>(arm)) {}

ArmDynamics::~ArmDynamics() = default;
ArmDynamics::ArmDynamics(ArmDynamics&&) noexcept = default;

std::size_t ArmDynamics::joints() const noexcept
{
  return solver_->chain.getNrOfJoints();
}

void ArmDynamics::torques(const std::vector<JointMotion>& motion, std::vector<double>& torques) noexcept
{
  Solver& solver = *solver_;
  for (unsigned i = 0; i < motion.size(); ++i)
  {
    solver.position(i) = motion[i].position;
    solver.velocity(i) = motion[i].velocity;
    solver.acceleration(i) = motion[i].acceleration;
  }
  solver.recursion.CartToJnt(solver.position, solver.velocity, solver.acceleration, solver.no_forces, solver.torque);
  for (unsigned i = 0; i < motion.size(); ++i)
  {
    torques[i] = solver.torque(i);
  }
}
}  // namespace hjt
