// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "model/ring_model.hpp"

namespace hjt
{
/// The ring at a position, and how it follows both angles from there: all that a failed move must restore.
struct RingState
{
  explicit RingState(const RingModel& model)
    : shape(model.restShape({}))
    , by_wave_generator(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
    , by_output(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
    , stiffness(Eigen::Matrix2d::Zero())
  {
  }

  /// Takes over another state but for the directions and lengths of its shape (RingShape::updateGeometry).
  void keep(const RingState& other) noexcept
  {
    const auto copy = [](const Eigen::VectorXd& from, Eigen::VectorXd& to)
    { std::copy(from.data(), from.data() + from.size(), to.data()); };
    copy(other.shape.points, shape.points);
    shape.space = other.shape.space;
    shape.solved = other.shape.solved;
    position = other.position;
    copy(other.by_wave_generator, by_wave_generator);
    copy(other.by_output, by_output);
    stiffness = other.stiffness;
    cup_stiffness = other.cup_stiffness;
    residual = other.residual;
  }

  RingShape shape;
  DrivePosition position;
  Eigen::VectorXd by_wave_generator;  ///< rates of the tooth points in equilibrium [m/rad]
  Eigen::VectorXd by_output;          ///< [m/rad]
  Eigen::Matrix2d stiffness;          ///< by (wave generator, output) angle, the ring following [N.m/rad]
  double cup_stiffness{};  ///< slope of the cup that rates and stiffness are of; 0: they are of no tangent [N.m/rad]
  double residual{};       ///< largest out-of-balance force component on a tooth [N]
};
}  // namespace hjt
