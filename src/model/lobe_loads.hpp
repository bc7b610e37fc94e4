// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "harmonic_joint_twin/model/lobe_loads.hpp"

namespace hjt
{
/// Forces on the teeth at one instant; a view, nothing is copied. One entry per tooth of the flexspline.
struct ToothSample
{
  Eigen::Ref<const Eigen::VectorXd> mesh_force;            ///< on the flank, signed by flank [N]
  Eigen::Ref<const Eigen::VectorXd> wave_generator_force;  ///< [N]
  Eigen::Ref<const Eigen::VectorXd> tooth_angle;           ///< where the tooth stands [rad]
  double wave_generator_angle;                             ///< of the major axis [rad]
};

/// The first lobe lies at the wave generator's angle, the second half a turn on.
LobeLoads lobeLoads(const ToothSample& sample) noexcept;
}  // namespace hjt
