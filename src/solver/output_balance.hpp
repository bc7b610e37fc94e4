// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/ring_equilibrium.hpp"

namespace hjt
{
/// Moves the ring to a wave generator angle [rad] and the output to the angle at which the mesh balances `load_torque`
/// [N.m] (> 0 resists positive rotation): Newton on the output angle with the ring's condensed stiffness.
SolveStatus balanceOutput(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept;
}  // namespace hjt
