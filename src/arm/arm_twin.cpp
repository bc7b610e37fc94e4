// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_twin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "base/number_text.hpp"
#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
/// Weights of the last three values, the newest first, in an extrapolation to the next step; row k for order k [-].
constexpr std::array<std::array<double, 3>, 3> EXTRAPOLATIONS{
  { { 1.0, 0.0, 0.0 }, { 2.0, -1.0, 0.0 }, { 3.0, -3.0, 1.0 } }
};

/// Least inertia of the arm that each drive moves, over many random poses [kg.m^2].
std::vector<double> leastInertia(ArmDynamics& dynamics, const std::vector<double>& spline_inertia)
{
  constexpr int POSES = 500;
  constexpr double MARGIN = 0.8;  // factor on the least inertia of the drawn poses; other poses may have less [-]
  const auto joints = static_cast<Eigen::Index>(spline_inertia.size());
  std::vector<JointMotion> pose(spline_inertia.size());
  std::vector<double> least(spline_inertia.size(), std::numeric_limits<double>::infinity());
  Eigen::MatrixXd mass(joints, joints);
  std::mt19937 generator(1);
  for (int i = 0; i < POSES; ++i)
  {
    for (JointMotion& joint : pose)
    {
      // The program uses no distribution of the standard library, because its numbers depend on the compiler.
      joint.position = TWO_PI * static_cast<double>(generator()) / static_cast<double>(std::mt19937::max());
    }
    dynamics.massMatrix(pose, mass);
    mass.diagonal() += Eigen::Map<const Eigen::VectorXd>(spline_inertia.data(), joints);
    const Eigen::MatrixXd inverse = mass.ldlt().solve(Eigen::MatrixXd::Identity(joints, joints));
    for (std::size_t k = 0; k < least.size(); ++k)
    {
      const auto j = static_cast<Eigen::Index>(k);
      least[k] = std::min(least[k], MARGIN / inverse(j, j));
    }
  }
  return least;
}

void requireDrive(const ArmDescription& arm, std::size_t joint, const std::vector<Parameters>& drives)
{
  const Parameters& drive = drives[joint];
  const auto require = [&](bool good, const std::string& what)
  {
    if (!good)
    {
      throw ParameterError(arm.origin + ": joint " + arm.joints[joint].name + ": " + what);
    }
  };
  require(drive.solver.rate == drives.front().solver.rate, "solver.rate = " + numberText(drive.solver.rate) +
                                                               " Hz differs from that of the first joint, " +
                                                               numberText(drives.front().solver.rate) + " Hz");
  require(drive.output.gravity_torque == 0.0, "output.gravity_torque = " + numberText(drive.output.gravity_torque) +
                                                  " N.m would count the weight twice: it must be 0 in an arm");
}
}  // namespace

ArmTwin::ArmTwin(const ArmDescription& arm, std::vector<Parameters> drives, const std::vector<double>& start,
                 const SurfaceSource& surface_source, const ArmCoupling& coupling)
  : dynamics_(arm)
  , pose_at_start_(start)
  , zero_(start)
  , motion_(arm.joints.size())
  , next_(motion_)
  , bias_(arm.joints.size())
{
  const std::size_t joints = arm.joints.size();
  if (drives.size() != joints || start.size() != joints)
  {
    throw ParameterError(arm.origin + " has " + std::to_string(joints) + " joints, but the caller gave " +
                         std::to_string(drives.size()) + " drives and " + std::to_string(start.size()) + " angles");
  }
  for (std::size_t i = 0; i < joints; ++i)
  {
    requireDrive(arm, i, drives);
    spline_inertia_.push_back(drives[i].output.circular_spline_inertia);
  }
  const double rate = drives.front().solver.rate;
  if (!(coupling.mass_rate > 0.0 && coupling.mass_rate <= rate))
  {
    throw ParameterError("the mass matrix's rate of " + numberText(coupling.mass_rate) +
                         " Hz is not within 0 ... solver.rate = " + numberText(rate) + " Hz");
  }
  mass_steps_ = std::llround(rate / coupling.mass_rate);
  if (coupling.order < 0 || static_cast<std::size_t>(coupling.order) >= EXTRAPOLATIONS.size())
  {
    throw ParameterError("the extrapolation's order of " + std::to_string(coupling.order) + " is not within 0 ... " +
                         std::to_string(EXTRAPOLATIONS.size() - 1));
  }
  weights_ = EXTRAPOLATIONS.at(static_cast<std::size_t>(coupling.order));
  const std::vector<double> least = leastInertia(dynamics_, spline_inertia_);
  drives_.reserve(joints);
  for (std::size_t i = 0; i < joints; ++i)
  {
    drives[i].output.load_inertia = std::max(least[i] - spline_inertia_[i], 0.0);
    drives[i].brake.engaged_at_start = true;
    drives_.emplace_back(drives[i], surface_source);
  }
  const auto size = static_cast<Eigen::Index>(joints);
  mass_.setZero(size, size);
  inverse_ = mass_;
  factors_.compute(Eigen::MatrixXd::Identity(size, size));
  excess_.setZero(size);
  link_torques_.fill(excess_);
  reset(0);
}

bool ArmTwin::reset(Stamp stamp) noexcept
{
  for (std::size_t i = 0; i < motion_.size(); ++i)
  {
    motion_[i] = { pose_at_start_[i], 0.0, 0.0 };
  }
  next_ = motion_;
  steps_ = 0;
  dynamics_.torques(next_, bias_);
  takeMass();
  bool good = true;
  for (std::size_t i = 0; i < drives_.size(); ++i)
  {
    const auto k = static_cast<Eigen::Index>(i);
    drives_[i].coupleArm(1.0 / inverse_(k, k) - spline_inertia_[i], bias_[i]);
    good = drives_[i].reset(stamp) && good;
    link_torques_[0][k] = bias_[i];
    // At the start angles the arm's weight has already twisted the drives.
    zero_[i] = motion_[i].position - drives_[i].outputs().output_angle;
  }
  link_torques_.fill(link_torques_[0]);
  energy_at_start_ = armEnergy();
  return good;
}

/// Computes the mass matrix M + D at a pose.
void ArmTwin::setMass(const std::vector<JointMotion>& pose) noexcept
{
  dynamics_.massMatrix(pose, mass_);
  mass_.diagonal() += Eigen::Map<const Eigen::VectorXd>(spline_inertia_.data(), mass_.rows());
}

/// Computes the mass matrix M + D at the predicted pose, and its inverse W.
void ArmTwin::takeMass() noexcept
{
  setMass(next_);
  factors_.compute(mass_);
  inverse_.setIdentity();
  factors_.solveInPlace(inverse_);
}

bool ArmTwin::step(Stamp until) noexcept
{
  if (stamp() + stepLength() > until)
  {
    return false;
  }
  const double length = toSeconds(stepLength());
  for (std::size_t i = 0; i < motion_.size(); ++i)
  {
    const JointMotion& joint = motion_[i];
    next_[i].velocity = joint.velocity + length * joint.acceleration;
    next_[i].position = joint.position + 0.5 * length * (joint.velocity + next_[i].velocity);
    next_[i].acceleration = 0.0;
  }
  dynamics_.torques(next_, bias_);
  if (steps_ % mass_steps_ == 0)
  {
    takeMass();
  }
  ++steps_;
  couple();
  for (Twin& drive : drives_)
  {
    drive.step(until);
  }
  observe();
  return true;
}

/// Gives each drive the inertia 1/W_ii and the load of its joint at the end of the step (comment of the class).
void ArmTwin::couple() noexcept
{
  const auto joints = static_cast<Eigen::Index>(drives_.size());
  excess_ = weights_[0] * link_torques_[0] + weights_[1] * link_torques_[1] + weights_[2] * link_torques_[2] -
            Eigen::Map<const Eigen::VectorXd>(bias_.data(), joints);
  for (Eigen::Index i = 0; i < joints; ++i)
  {
    const auto k = static_cast<std::size_t>(i);
    const double inertia = 1.0 / inverse_(i, i);
    const double others = inverse_.row(i).dot(excess_) - inverse_(i, i) * excess_[i];
    drives_[k].coupleArm(inertia - spline_inertia_[k], bias_[k] - inertia * others);
  }
}

void ArmTwin::observe() noexcept
{
  link_torques_[2].swap(link_torques_[1]);
  link_torques_[1].swap(link_torques_[0]);
  for (std::size_t i = 0; i < drives_.size(); ++i)
  {
    link_torques_[0][static_cast<Eigen::Index>(i)] = drives_[i].linkTorque();
  }
  excess_ = link_torques_[0] - Eigen::Map<const Eigen::VectorXd>(bias_.data(), excess_.size());
  for (std::size_t i = 0; i < drives_.size(); ++i)
  {
    const JointOutputs outputs = drives_[i].outputs();
    const double acceleration = inverse_.row(static_cast<Eigen::Index>(i)).dot(excess_);
    motion_[i] = { zero_[i] + outputs.output_angle, outputs.output_velocity, acceleration };
  }
}

double ArmTwin::armEnergy() noexcept
{
  setMass(motion_);
  double energy = dynamics_.potentialEnergy(motion_);
  for (std::size_t i = 0; i < motion_.size(); ++i)
  {
    for (std::size_t k = 0; k < motion_.size(); ++k)
    {
      const double inertia = mass_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      energy += 0.5 * motion_[i].velocity * inertia * motion_[k].velocity;
    }
  }
  return energy;
}

double ArmTwin::deliveredEnergy() const noexcept
{
  double energy = 0.0;
  for (const Twin& drive : drives_)
  {
    energy += drive.deliveredEnergy();
  }
  return energy;
}

double ArmTwin::energyResidual() noexcept
{
  return deliveredEnergy() - (armEnergy() - energy_at_start_);
}
}  // namespace hjt
