// SPDX-License-Identifier: BSD-3-Clause
#include "studies/travelling_ring.hpp"

#include "solver/output_balance.hpp"

namespace hjt
{
SolveStatus travelInEquilibrium(const RingEquilibrium& ring, double speed, double load, RingMotion& motion)
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
