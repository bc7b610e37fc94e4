// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/ring_equilibrium.hpp"
#include "studies/ring_stepper.hpp"

namespace hjt
{
/// Positions and speeds of a ring that travels in equilibrium while the wave generator turns at `speed` [rad/s] under a
/// constant `load` [N.m]. `ring`: in equilibrium under that load. The output, too heavy to follow the drive within a
/// tooth pitch, turns at its mean speed over one. @returns false if an equilibrium was not found.
SolveStatus travelInEquilibrium(const RingEquilibrium& ring, double speed, double load, RingMotion& motion);
}  // namespace hjt
