// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/output_balance.hpp"
#include "solver/ring_equilibrium.hpp"
#include "studies/ring_stepper.hpp"

namespace hjt
{
/// Positions and speeds of a ring that travels in equilibrium while the wave generator turns at `speed` [rad/s] under a
/// constant `load` [N.m]. `ring`: in equilibrium under that load. The output, too heavy to follow the drive within a
/// tooth pitch, turns at its mean speed over one. @returns false if an equilibrium was not found.
inline SolveStatus travelInEquilibrium(const RingEquilibrium& ring, double speed, double load, RingMotion& motion)
{
  const double pitch = ring.model().rest.pitchAngle();
  RingEquilibrium ahead = ring;
  const SolveStatus status = balanceOutput(ahead, ring.position().wave_generator_angle + pitch, load);
  if (!status.ok())
  {
    return status;
  }
  const double output_speed = speed * (ahead.position().output_angle - ring.position().output_angle) / pitch;
  motion.q << ring.shape().points, ring.position().wave_generator_angle, ring.position().output_angle;
  motion.v << speed * ring.byWaveGenerator() + output_speed * ring.byOutput(), speed, output_speed;
  return status;
}
}  // namespace hjt
