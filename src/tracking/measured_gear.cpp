// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/measured_gear.hpp"

#include <cmath>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "model/faults/joint_faults.hpp"
#include "model/lobe_loads.hpp"
#include "params/variants.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/static_solver.hpp"
#include "twin/tooth_forces.hpp"

namespace hjt
{
namespace
{
/// Largest turn of the wave generator from one solution to the next; for a larger one the class inserts it anew [rad].
constexpr double LONG_WAY = 0.5;
}  // namespace

MeasuredGear::MeasuredGear(const Parameters& parameters)
  : model_(startingJoint(parameters))
  , ring_(model_.ring, staticSolver(parameters.solver))
  , stress_(parameters)
  , teeth_are_alike_(teethAreAlike(parameters))
  , pitch_(model_.ring.rest.pitchAngle())
  , ratio_(nominalRatio(parameters.gear))
  , torque_limit_(parameters.output.load_torque_limit)
  , tooth_angles_(Eigen::VectorXd::LinSpaced(parameters.gear.teeth_flexspline, 0.0,
                                             (parameters.gear.teeth_flexspline - 1) * pitch_))
{
  const SolveStatus status = insertUnderLoad(ring_, 0.0, 0.0);
  if (!status.ok())
  {
    throw ParameterError("the unloaded gear has no equilibrium: " + explanationOf(status));
  }
}

bool MeasuredGear::moveTo(double position, double joint_torque) noexcept
{
  constexpr int MAX_ROUNDS = 5;
  constexpr double CLOSE = 1e-6;  // largest change of the motor angle in the last round [rad]
  if (!std::isfinite(position) || !(std::abs(joint_torque) <= torque_limit_))
  {
    return false;
  }
  double torsion = torsion_;
  for (int i = 0; i < MAX_ROUNDS; ++i)
  {
    const double motor_angle = ratio_ * (position + torsion);
    if (!solve(motor_angle, joint_torque))
    {
      return false;
    }
    const double before = torsion;
    torsion = ring_.position().wave_generator_angle / ratio_ - ring_.position().output_angle;
    position_ = position;
    motor_angle_ = motor_angle;
    torsion_ = torsion;
    if (ratio_ * std::abs(torsion - before) < CLOSE)
    {
      break;
    }
  }
  return true;
}

/// Finds the equilibrium of the ring at an angle of the wave generator [rad] under a torque on the output [N.m].
/// Returns false if the solver finds none.
bool MeasuredGear::solve(double motor_angle, double joint_torque) noexcept
{
  const std::int64_t shift = teeth_are_alike_ ? static_cast<std::int64_t>(std::floor(motor_angle / pitch_)) : 0;
  const double angle = motor_angle - static_cast<double>(shift) * pitch_;
  SolveStatus status;
  if (is_lost_ || std::abs(angle - ring_.position().wave_generator_angle) > LONG_WAY)
  {
    status = ring_.insert({ angle, angle / ratio_ - torsion_, model_.ring.gear.wave_amplitude });
  }
  if (status.ok())
  {
    status = balanceOutput(ring_, angle, joint_torque);
  }
  is_lost_ = !status.ok();
  if (is_lost_)
  {
    torsion_ = 0.0;
    return false;
  }
  shift_ = shift;
  residual_ = status.residual;
  return true;
}

LobeLoads MeasuredGear::lobes() const noexcept
{
  const RingForces& forces = ring_.forces();
  return lobeLoads({ forces.of<ToothMesh>().flank_force, forces.of<WaveGeneratorContact>().force, tooth_angles_,
                     ring_.position().wave_generator_angle });
}

/// Number of the tooth of the drive that tooth 0 of the ring stands for.
int MeasuredGear::firstTooth() const noexcept
{
  const std::int64_t teeth = tooth_angles_.size();
  return static_cast<int>(((shift_ % teeth) + teeth) % teeth);
}

void MeasuredGear::fill(ToothForces& forces) const noexcept
{
  fillToothForces(ring_, firstTooth(), forces);
}

void MeasuredGear::fill(ToothStress& stress) const noexcept
{
  stress_.at(ring_, firstTooth(), stress);
}
}  // namespace hjt
