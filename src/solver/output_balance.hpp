// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/ring_equilibrium.hpp"

namespace hjt
{
/// Moves the ring to a wave generator angle [rad] and the output to the angle at which the mesh balances `load_torque`
/// [N.m] (> 0 resists positive rotation): Newton on the output angle with the ring's condensed stiffness.
///
/// A step is bounded by a trust region, which begins at a hundredth of a tooth space, grows while the torque comes
/// closer and shrinks where it does not. Without stiffness (backlash) a step is as long as the region. On failure
/// `unbalanced_torque` is what the mesh lacks at the last angle.
SolveStatus balanceOutput(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept;

/// Inserts the wave generator at its full amplitude and balances the load.
SolveStatus insertUnderLoad(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept;

/// Torque at the output that counts as balanced [N.m]: 1e-11 of the torque which turns the output by a tooth space on
/// the present stiffness, or what rounding leaves of the ring's forces.
double balanceTolerance(const RingEquilibrium& ring) noexcept;
}  // namespace hjt
