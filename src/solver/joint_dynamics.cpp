// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/solver/joint_dynamics.hpp"

#include <cmath>

#include "harmonic_joint_twin/solver/output_balance.hpp"

namespace hjt
{
JointDynamics::JointDynamics(const JointModel& model, const SolverParameters& parameters)
  : model_(model)
  , ring_(model.ring, parameters)
  , dry_(model.inertia(), parameters.stiction_velocity)
  , friction_(model.ring.rest.teeth())
  , running_(2 * model.ring.rest.teeth())
{
}

SolveStatus JointDynamics::settle() noexcept
{
  constexpr int MAX_ITERATIONS = 50;
  SolveStatus result = ring_.insert({ 0.0, 0.0, model_.ring.gear.wave_amplitude });
  // Gravity changes with the output angle; the joint is stiff, so taking it as constant and repeating converges fast.
  double torque = 0.0;
  for (int i = 0; i < MAX_ITERATIONS && result.ok(); ++i)
  {
    const double wanted = inputs.load_torque - model_.load.gravityTorque(ring_.position().output_angle);
    if (i > 0 && std::abs(wanted - torque) < 1e-9)
    {
      break;
    }
    torque = wanted;
    result = balanceOutput(ring_, 0.0, torque);
  }
  status = result;
  return result;
}

SolveStatus JointDynamics::place(double motor_angle, double output_angle) noexcept
{
  const DrivePosition target{ motor_angle, output_angle, model_.ring.gear.wave_amplitude };
  SolveStatus result = ring_.moveTo(target);
  if (!result.ok() && std::isfinite(motor_angle) && std::isfinite(output_angle))
  {
    const SolveStatus again = ring_.reinsert(target);
    result.code = again.code;
    result.residual = again.residual;
    result.iterations += again.iterations;
    result.cuts += again.cuts;
    result.jumps = again.jumps;
  }
  status.iterations += result.iterations;
  status.cuts += result.cuts;
  status.jumps += result.jumps;
  status.residual = result.residual;
  if (!result.ok())
  {
    status.code = result.code;
  }
  return result;
}

double JointDynamics::follow() const noexcept
{
  const Eigen::Matrix2d& k = ring_.stiffness();
  return k(1, 1) > 0.0 ? -k(1, 0) / k(1, 1) : 0.0;
}

void JointDynamics::updateFriction(const Eigen::Vector2d& speeds) noexcept
{
  const RingRates rates{ ring_.byWaveGenerator(), ring_.byOutput() };
  model_.friction(ring_.shape(), ring_.position(), ring_.forces(), rates, follow(), speeds, inputs, running_,
                  friction_);
}

void JointDynamics::operator()(const JointState& x, JointState& rate, double) noexcept
{
  using namespace joint_state;
  const Eigen::Vector2d speeds = x.segment<2>(MOTOR_SPEED);
  rate.setZero();
  if (!place(x[MOTOR_ANGLE], x[OUTPUT_ANGLE]).ok())
  {
    return;
  }
  updateFriction(speeds);
  const Eigen::Vector2d drag = dry_.torque(friction_, follow(), speeds);
  rate.segment<2>(MOTOR_ANGLE) = speeds;
  rate.segment<2>(MOTOR_SPEED) = (torque() + drag).cwiseQuotient(model_.inertia());
  rate[MOTOR_WORK] = inputs.motor_torque * speeds[0];
  rate[LOAD_WORK] = inputs.load_torque * speeds[1];
  rate[DISSIPATED] = -drag.dot(speeds);
}
}  // namespace hjt
