// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <memory>
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
    arm.payload = {};
    bare_ = std::make_unique<ArmDynamics>(arm);
    const auto add = [&](const std::array<double, 3>& centre)
    {
      arm.payload = { SMALL, centre };
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

  double linksMass() const { return bare_->mass(); }  ///< [kg]

  /// Of mass and moments, and of gravity along each axis of the base's frame, at each joint, by column
  /// [N.m/kg], [N.m/(kg.m)], [N.m/(m/s^2)].
  void torques(const std::vector<JointMotion>& motion, Eigen::MatrixXd& columns)
  {
    const auto at = [&](ArmDynamics& dynamics, std::vector<double>& torques)
    {
      torques.resize(motion.size());
      dynamics.torques(motion, torques);
    };
    at(*bare_, first_);
    at(loaded_[0], second_);
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      columns(static_cast<Eigen::Index>(i), 0) = (second_[i] - first_[i]) / SMALL;
    }
    // To both sides: what of a payload's inertia is quadratic in its centre cancels out.
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      at(loaded_[1 + 2 * axis], first_);
      at(loaded_[2 + 2 * axis], second_);
      for (std::size_t i = 0; i < motion.size(); ++i)
      {
        columns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(1 + axis)) =
            (first_[i] - second_[i]) / (2.0 * SMALL);
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
  static constexpr double SMALL = 1e-3;  // [kg]

  std::unique_ptr<ArmDynamics> bare_;
  std::vector<ArmDynamics> loaded_;
  std::vector<ArmDynamics> weights_;  // of gravity along each axis
  std::vector<JointMotion> rest_;
  std::vector<double> first_;
  std::vector<double> second_;
};
}  // namespace hjt
