// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Radius of the bearing's outer race over that of the rim's bore, both free and round: the fit and what the wave
/// generator's excess of temperature adds to it. > 0 interference [m].
inline double raceFit(const Parameters& parameters) noexcept
{
  constexpr double EXPANSION = 11.5e-6;  // of steel [1/K]
  return parameters.contact.fit +
         EXPANSION * parameters.gear.flexspline_inner_radius * parameters.contact.temperature_difference;
}
}  // namespace hjt
