// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace hjt
{
/// One dry friction: a force against a slip. Power = strength * |slip . (motor speed, output speed)|.
struct FrictionTerm
{
  double strength;       ///< >= 0 [N] or [N.m]
  Eigen::Vector2d slip;  ///< slip speed by motor and output speed [m/rad] or [-]
};

/// All friction of the joint, seen through its two coordinates: dry terms and a viscous matrix.
///
/// The ring follows the two angles in equilibrium, so every slip in it is a combination of the two speeds, and friction
/// acts on the angles by virtual power. Its feedback on the shape of the ring, of the order of the friction
/// coefficient, is left out.
struct JointFriction
{
  /// Room for one term a tooth, the motor shaft's, the cup's and the output's.
  explicit JointFriction(int teeth) : running(2 * teeth) { terms.reserve(static_cast<std::size_t>(teeth) + 3); }

  void setZero() noexcept
  {
    terms.clear();
    viscous.setZero();
  }

  /// Power that the dry terms take at these speeds of motor and output [W], or torque by unit speed.
  double dryPower(const Eigen::Vector2d& speeds) const noexcept
  {
    double power = 0.0;
    for (const FrictionTerm& term : terms)
    {
      power += term.strength * std::abs(term.slip.dot(speeds));
    }
    return power;
  }

  std::vector<FrictionTerm> terms;
  double presliding{};  ///< dry friction at the motor shaft that is no term: it builds up over an angle [N.m]
  Eigen::Matrix2d viscous{ Eigen::Matrix2d::Zero() };  ///< torque by speed, positive semi-definite [N.m.s/rad]
  Eigen::VectorXd running;  ///< 2 N, rates of the ring's points by motor angle while the output follows [m/rad]
};
}  // namespace hjt
