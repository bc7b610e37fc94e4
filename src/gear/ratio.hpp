// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Ratio of motor angle to output angle that follows from the numbers of teeth, with the flexspline fixed (thesis
/// section 3.1) [-]. The model does not impose this ratio. Torsion and kinematic error are deviations from it.
inline double nominalRatio(const GearParameters& gear) noexcept
{
  return static_cast<double>(gear.teeth_circular_spline) / (gear.teeth_circular_spline - gear.teeth_flexspline);
}
}  // namespace hjt
