// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "arm/arm_dynamics.hpp"

namespace hjt
{
/// Torques at an arm's joints of unit payloads, and of unit gravity.
class UnitLoads
{
public:
  explicit UnitLoads(ArmDescription arm)
  {
    const std::array<double, 3> gravity = arm.gravity;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      arm.gravity = {};
      arm.gravity[axis] = 1.0;
      weights_.emplace_back(arm);
    }
    arm.gravity = gravity;
    for (ArmLink& link : arm.links)
    {
      links_mass_ += link.mass;
      link.mass = 0.0;
      link.inertia = {};
    }
    const auto add = [&](const std::array<double, 3>& centre)
    {
      arm.payload = { 1.0, centre };
      loaded_.emplace_back(arm);
    };
    add({});
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      std::array<double, 3> centre{};
      for (const double side : { 1.0, -1.0 })
      {
        centre[axis] = side;
        add(centre);
      }
    }
  }

  double linksMass() const { return links_mass_; }  ///< [kg]

  /// Of mass and moments, and of gravity along each axis of the base's frame, at each joint, by column
  /// [N.m/kg], [N.m/(kg.m)], [N.m/(m/s^2)].
  void torques(const std::vector<JointMotion>& motion, Eigen::MatrixXd& columns)
  {
    const auto at = [&](ArmDynamics& dynamics, std::vector<double>& torques)
    {
      torques.resize(motion.size());
      dynamics.torques(motion, torques);
    };
    at(loaded_[0], first_);
    columns.col(0) = Eigen::Map<const Eigen::VectorXd>(first_.data(), static_cast<Eigen::Index>(first_.size()));
    // To both sides: what of a payload's inertia is quadratic in its centre cancels out.
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      at(loaded_[1 + 2 * axis], first_);
      at(loaded_[2 + 2 * axis], second_);
      for (std::size_t i = 0; i < motion.size(); ++i)
      {
        columns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(1 + axis)) = 0.5 * (first_[i] - second_[i]);
      }
    }
    rest_.resize(motion.size());
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      rest_[i] = { motion[i].position, 0.0, 0.0 };
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      first_.resize(motion.size());
      weights_[axis].torques(rest_, first_);
      columns.col(static_cast<Eigen::Index>(4 + axis)) =
          Eigen::Map<const Eigen::VectorXd>(first_.data(), static_cast<Eigen::Index>(first_.size()));
    }
  }

private:
  double links_mass_{};               // [kg]
  std::vector<ArmDynamics> loaded_;   // of links without a mass
  std::vector<ArmDynamics> weights_;  // of gravity along each axis
  std::vector<JointMotion> rest_;
  std::vector<double> first_;
  std::vector<double> second_;
};
}  // namespace hjt
