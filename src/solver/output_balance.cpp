// SPDX-License-Identifier: BSD-3-Clause
#include "solver/output_balance.hpp"

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"

namespace hjt
{
namespace
{
double toothSpace(const RingEquilibrium& ring) noexcept
{
  return TWO_PI / ring.model().gear.teeth_circular_spline;
}

SolveStatus turnWaveGenerator(RingEquilibrium& ring, double angle) noexcept
{
  DrivePosition target = ring.position();
  const double turn = angle - target.wave_generator_angle;
  if (turn == 0.0)
  {
    return {};
  }
  target.wave_generator_angle = angle;
  // The output follows at constant load; one that hangs free in its backlash is carried along with the teeth.
  const double stiffness = ring.stiffness()(1, 1);
  target.output_angle +=
      stiffness > 0.0 ? -turn * ring.stiffness()(1, 0) / stiffness : turn / nominalRatio(ring.model().gear);
  return ring.moveTo(target);
}

SolveCode codeOfFailure(const RingEquilibrium& ring, double load_torque) noexcept
{
  if (!std::isfinite(load_torque))
  {
    return SolveCode::NOT_FINITE;
  }
  return ring.forces().output_torque == 0.0 ? SolveCode::DISENGAGED : SolveCode::UNBALANCED;
}
}  // namespace

double balanceTolerance(const RingEquilibrium& ring) noexcept
{
  constexpr double SHARE = 1e-11;  // share of a tooth space: a few roundings of an angle of some radians
  return std::max(SHARE * toothSpace(ring) * ring.stiffness()(1, 1),
                  ring.rounding() * ring.model().gear.flexspline_inner_radius);
}

SolveStatus balanceOutput(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept
{
  constexpr int MAX_IDLE = 20;          // iterations in a row that come no closer
  constexpr double CLOSER = 0.999;      // the excess has to fall below this share of the least one so far
  constexpr double FIRST_REACH = 0.01;  // of a tooth space
  constexpr double MAX_REACH = 0.25;    // farther, teeth would pair with other spaces
  SolveStatus total = turnWaveGenerator(ring, wave_generator_angle);
  double reach = FIRST_REACH * toothSpace(ring);
  double excess = ring.forces().output_torque - load_torque;
  double least = std::abs(excess);
  for (int idle = 0; total.ok() && !(std::abs(excess) <= balanceTolerance(ring));)
  {
    const double stiffness = ring.stiffness()(1, 1);
    const double step = stiffness > 0.0 ? excess / stiffness : std::copysign(reach, excess);
    DrivePosition target = ring.position();
    target.output_angle += std::clamp(step, -reach, reach);
    const SolveStatus moved = ring.moveTo(target);
    total.iterations += moved.iterations;
    total.cuts += moved.cuts;
    total.jumps += moved.jumps;
    total.residual = moved.residual;
    total.max_iterations = moved.max_iterations;
    const double before = std::abs(excess);
    excess = ring.forces().output_torque - load_torque;
    idle = std::abs(excess) < CLOSER * least ? 0 : idle + 1;
    least = std::min(least, std::abs(excess));
    reach =
        moved.ok() && std::abs(excess) <= before ? std::min(2.0 * reach, MAX_REACH * toothSpace(ring)) : 0.5 * reach;
    if (idle > MAX_IDLE)
    {
      total.code = codeOfFailure(ring, load_torque);
      total.stage = SolveStage::BALANCE;
      total.unbalanced_torque = -excess;
    }
  }
  return total;
}

SolveStatus insertUnderLoad(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept
{
  const SolveStatus status = ring.insert({ 0.0, 0.0, ring.model().gear.wave_amplitude });
  return status.ok() ? balanceOutput(ring, wave_generator_angle, load_torque).addEffort(status) : status;
}
}  // namespace hjt
