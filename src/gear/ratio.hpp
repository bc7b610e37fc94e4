// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Ratio motor angle over output angle that the tooth numbers prescribe with the flexspline fixed (thesis §3.1) [-].
/// Never imposed on the model: only the yardstick that torsion and kinematic error are measured against.
inline double nominalRatio(const GearParameters& gear) noexcept
{
  return static_cast<double>(gear.teeth_circular_spline) / (gear.teeth_circular_spline - gear.teeth_flexspline);
}
}  // namespace hjt
