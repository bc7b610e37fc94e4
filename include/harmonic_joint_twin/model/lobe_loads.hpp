// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace hjt
{
/// How the two lobes of the wave generator share the load.
struct LobeLoads
{
  int teeth_loaded{};  ///< number of teeth that carry mesh force [-]
  /// sum of the magnitudes of mesh force over the teeth within a quarter turn of each lobe [N]
  std::array<double, 2> mesh_force{};
  double asymmetry{};             ///< (first - second) / (first + second) mesh force; 0 without load [-]
  double wave_generator_force{};  ///< load of the wave generator's bearing: sum over all teeth [N]
};
}  // namespace hjt
