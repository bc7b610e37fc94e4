// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

  RingShape shape;
  DrivePosition position;
  Eigen::VectorXd by_wave_generator;  ///< rates of the tooth points in equilibrium [m/rad]
  Eigen::VectorXd by_output;          ///< [m/rad]
  Eigen::Matrix2d stiffness;          ///< by (wave generator, output) angle, the ring following [N.m/rad]
  double residual{};                  ///< largest out-of-balance force component on a tooth [N]
};
}  // namespace hjt
