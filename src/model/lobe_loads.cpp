// SPDX-License-Identifier: BSD-3-Clause
#include "model/lobe_loads.hpp"

#include <cmath>

namespace hjt
{
LobeLoads lobeLoads(const ToothSample& sample) noexcept
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
