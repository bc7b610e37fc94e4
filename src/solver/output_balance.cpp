// SPDX-License-Identifier: BSD-3-Clause
#include "solver/output_balance.hpp"

#include <algorithm>
#include <cmath>

#include "gear/ratio.hpp"

namespace hjt
{
SolveStatus balanceOutput(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept
{
  constexpr int MAX_ITERATIONS = 60;
  constexpr double MAX_STEP = 2e-4;          // rad, a few flank clearances
  constexpr double TORQUE_TOLERANCE = 1e-8;  // N.m
  SolveStatus total;
  DrivePosition target = ring.position();
  const double turn = wave_generator_angle - target.wave_generator_angle;
  if (turn != 0.0)
  {
    target.wave_generator_angle = wave_generator_angle;
    // The output follows at constant load; one that hangs free in its backlash is carried along with the teeth.
    const double stiffness = ring.stiffness()(1, 1);
    target.output_angle +=
        stiffness > 0.0 ? -turn * ring.stiffness()(1, 0) / stiffness : turn / nominalRatio(ring.model().gear);
    total = ring.moveTo(target);
  }
  for (int i = 0; i < MAX_ITERATIONS && total.ok(); ++i)
  {
    const double excess = ring.forces().output_torque - load_torque;
    if (std::abs(excess) <= TORQUE_TOLERANCE)
    {
      return total;
    }
    const double stiffness = ring.stiffness()(1, 1);
    const double step = stiffness > 0.0 ? excess / stiffness : std::copysign(MAX_STEP, excess);
    target.output_angle = ring.position().output_angle + std::clamp(step, -MAX_STEP, MAX_STEP);
    const SolveStatus status = ring.moveTo(target);
    total.iterations += status.iterations;
    total.cuts += status.cuts;
    total.residual = status.residual;
    total.code = status.code;
  }
  if (total.ok())
  {
    total.code = SolveCode::NOT_CONVERGED;
  }
  return total;
}
}  // namespace hjt
