// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
KDL::Vector vectorOf(const std::array<double, 3>& values)
{
  return { values[0], values[1], values[2] };
}

/// Of the '>' that ends a tag, not of one in an attribute.
std::size_t endOfTag(const std::string& xml, std::size_t at)
{
  constexpr const char* ENDS = ">\"'";
  at = xml.find_first_of(ENDS, at);
  while (at != std::string::npos && xml[at] != '>')
  {
    const std::size_t closing = xml.find(xml[at], at + 1);
    at = closing == std::string::npos ? closing : xml.find_first_of(ENDS, closing + 1);
  }
  return at;
}

/// Elements within elements, at most. A parser of XML may take a time that grows with the square of it.
std::size_t depthOf(const std::string& xml)
{
  std::size_t depth = 0;
  std::size_t deepest = 0;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at))
  {
    const auto begins = [&](const char* text) { return xml.compare(at, std::strlen(text), text) == 0; };
    const std::size_t last = begins("<!--")      ? xml.find("-->", at) :
                             begins("<![CDATA[") ? xml.find("]]>", at) :
                                                   endOfTag(xml, at);
    if (begins("</"))
    {
      depth -= depth > 0 ? 1 : 0;
    }
    else if (!begins("<!") && !begins("<?") && last != std::string::npos && xml[last - 1] != '/')
    {
      deepest = std::max(deepest, ++depth);
    }
    at = std::min(last, xml.size() - 1) + 1;
  }
  return deepest;
}

/// @throws ParameterError where the link that a joint carries, or its place, is none that a robot can have.
void requirePlausible(const ArmDescription& arm, const KDL::Segment& segment)
{
  const KDL::Joint& joint = segment.getJoint();
  const auto require = [&](bool good, const std::string& what)
  {
    if (!good)
    {
      throw ParameterError(arm.origin + ": its URDF: joint '" + joint.getName() + "' with link '" + segment.getName() +
                           "': " + what);
    }
  };
  // All written so that NaN fails.
  const auto require_range = [&](const char* what, double value, const char* unit, const Range& range)
  {
    require(value >= range.min && value <= range.max, std::string(what) + " = " + numberText(value) + " [" + unit +
                                                          "] is out of range, allowed: " + rangeText(range) + " [" +
                                                          unit + "]");
  };
  const KDL::Vector axis = joint.JointAxis();
  require(joint.getType() == KDL::Joint::None || std::abs(KDL::dot(axis, axis) - 1.0) < 1e-6,
          "its axis has no direction");
  KDL::RigidBodyInertia body = segment.getInertia();  // RefPoint() is not const
  const KDL::RotationalInertia inertia = body.RefPoint(body.getCOG()).getRotationalInertia();
  require_range("mass", body.getMass(), "kg", Range{ 0.0, 1e4 });
  for (int i = 0; i < 3; ++i)
  {
    require_range("origin", segment.pose(0.0).p(i), "m", Range{ -100.0, 100.0 });
    require_range("centre of mass", body.getCOG()(i), "m", Range{ -100.0, 100.0 });
    for (int k = 0; k < 3; ++k)
    {
      // Rounding makes a little less of none.
      require_range("inertia", inertia.data[3 * i + k], "kg.m^2", Range{ i == k ? -1e-9 : -1e6, 1e6 });
    }
  }
}

KDL::Chain chainOf(const ArmDescription& arm)
{
  constexpr std::size_t MAX_DEPTH = 100;
  if (depthOf(arm.urdf) > MAX_DEPTH)
  {
    throw ParameterError(arm.origin + ": its URDF has more than " + std::to_string(MAX_DEPTH) +
                         " elements within each other");
  }
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
    requirePlausible(arm, segment);
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
    , gravity(vectorOf(arm.gravity))
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

  void setPositions(const std::vector<JointMotion>& motion) noexcept
  {
    for (unsigned i = 0; i < motion.size(); ++i)
    {
      position(i) = motion[i].position;
    }
  }

  /// Of the end of each segment, from the base on, given to `visit`.
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

  KDL::Chain chain;
  KDL::Vector gravity;
  KDL::ChainIdSolver_RNE recursion;
  KDL::ChainDynParam parameters;
  KDL::JntArray position;
  KDL::JntArray velocity;
  KDL::JntArray acceleration;
  KDL::JntArray torque;
  KDL::JntSpaceInertiaMatrix mass;
  KDL::Wrenches forces;  // on each segment, in its frame
};

ArmDynamics::ArmDynamics(const ArmDescription& arm) : solver_(std::make_unique<Solver>(arm)) {}

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

void ArmDynamics::torques(const std::vector<JointMotion>& motion, std::vector<double>& torques) noexcept
{
  Solver& solver = *solver_;
  solver.setPositions(motion);
  for (unsigned i = 0; i < motion.size(); ++i)
  {
    solver.velocity(i) = motion[i].velocity;
    solver.acceleration(i) = motion[i].acceleration;
  }
  const KDL::Wrench wrench(vectorOf(wrench_.force), vectorOf(wrench_.moment));
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
