// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "harmonic_joint_twin/model/lobe_loads.hpp"

namespace hjt
{
/// Forces on the teeth at one instant, with one entry for each tooth of the flexspline.
struct ToothSample
{
  Eigen::Ref<const Eigen::VectorXd> mesh_force;            ///< force on each flank; > 0 leading, < 0 trailing flank [N]
  Eigen::Ref<const Eigen::VectorXd> wave_generator_force;  ///< force of the wave generator on each tooth [N]
  Eigen::Ref<const Eigen::VectorXd> tooth_angle;           ///< angle of each tooth [rad]
  double wave_generator_angle;                             ///< angle of the major axis [rad]
};

/// Loads of both lobes. The first lobe is at the wave generator's angle, the second lobe half a turn away.
inline LobeLoads lobeLoads(const ToothSample& sample) noexcept
{
  LobeLoads loads;
  for (Eigen::Index i = 0; i < sample.mesh_force.size(); ++i)
  {
    const double force = std::abs(sample.mesh_force[i]);
    loads.wave_generator_force += sample.wave_generator_force[i];
    if (force > 0.0)
    {
      const bool first = std::cos(sample.tooth_angle[i] - sample.wave_generator_angle) >= 0.0;
      loads.mesh_force[first ? 0 : 1] += force;
      ++loads.teeth_loaded;
    }
  }
  const double sum = loads.mesh_force[0] + loads.mesh_force[1];
  loads.asymmetry = sum > 0.0 ? (loads.mesh_force[0] - loads.mesh_force[1]) / sum : 0.0;
  return loads;
}
}  // namespace hjt
