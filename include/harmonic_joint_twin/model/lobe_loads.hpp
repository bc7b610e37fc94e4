// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace hjt
{
/// Loads of the two lobes of the wave generator.
struct LobeLoads
{
  int teeth_loaded{};  ///< number of teeth that carry mesh force [-]
  /// for each lobe the sum of |mesh force| over the teeth within a quarter turn of the lobe [N]
  std::array<double, 2> mesh_force{};
  double asymmetry{};             ///< (mesh force at lobe 0 - that at lobe 1) over their sum; 0 without load [-]
  double wave_generator_force{};  ///< load of the wave generator's bearing: sum of its forces on all teeth [N]
};
}  // namespace hjt
