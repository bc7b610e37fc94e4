// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace hjt
{
/// How the two lobes of the wave generator share the load.
struct LobeLoads
{
  int teeth_loaded{};                  ///< teeth that carry mesh force [-]
  std::array<double, 2> mesh_force{};  ///< sum of magnitudes over the teeth within a quarter turn of each lobe [N]
  double asymmetry{};                  ///< (first - second) / (first + second), 0 when unloaded [-]
  double wave_generator_force{};       ///< sum over all teeth: load of the wave generator's bearing [N]
};
}  // namespace hjt
