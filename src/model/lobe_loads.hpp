// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

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

/// How the two lobes of the wave generator share the load.
struct LobeLoads
{
  int teeth_loaded{};                  ///< teeth that carry mesh force [-]
  std::array<double, 2> mesh_force{};  ///< sum of magnitudes over the teeth within a quarter turn of each lobe [N]
  double asymmetry{};                  ///< (first - second) / (first + second), 0 when unloaded [-]
  double wave_generator_force{};       ///< sum over all teeth: load of the wave generator's bearing [N]
};

/// The first lobe lies at the wave generator's angle, the second half a turn on.
LobeLoads lobeLoads(const ToothSample& sample) noexcept;
}  // namespace hjt
