// SPDX-License-Identifier: BSD-3-Clause
#include "studies/energy_ledger.hpp"

#include <algorithm>
#include <cmath>

#include "solver/joint_stepper.hpp"

namespace hjt
{
RandomDrive::RandomDrive(const RandomDriveSettings& settings, const Parameters& parameters)
  : random_(settings.seed)
  , load_(settings.load)
  , brake_(settings.brake)
  , rate_(parameters.solver.rate)
  , torque_limit_(parameters.motor.torque_limit)
{
  inputs_.temperature = parameters.input.temperature;
}

JointInputs RandomDrive::next(const Motor& motor, double motor_speed)
{
  constexpr double MILLISECOND = 1e-3;  // all changes fall on whole ones, so that every step meets them
  constexpr double BRAKE_CHANCE = 0.2;
  if (left_-- == 0)
  {
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    std::uniform_int_distribution<int> hold(10, 50);
    left_ = std::max(1, static_cast<int>(std::lround(rate_ * MILLISECOND * hold(random_)))) - 1;
    command_ = torque_limit_ * (2.0 * chance(random_) - 1.0);
    inputs_.load_torque = chance(random_) < 0.5 ? load_ * (2.0 * chance(random_) - 1.0) : inputs_.load_torque;
    inputs_.brake_engaged = brake_ && chance(random_) < BRAKE_CHANCE;
  }
  inputs_.motor_torque = motor.drive(command_, motor_speed).torque;
  return inputs_;
}

LedgerResult runLedger(const Parameters& parameters, const RandomDriveSettings& settings, double duration,
                       const std::function<void(double)>& progress)
{
  const JointModel model(parameters);
  JointStepper stepper(parameters, model);
  RandomDrive drive(settings, parameters);
  LedgerResult result;
  const auto steps = static_cast<long>(std::lround(duration * parameters.solver.rate));
  bool converged = true;
  for (long i = 0; i < steps && converged; ++i)
  {
    const double angle = stepper.motorAngle();
    const double speed = stepper.speeds()[0];
    converged = stepper.step(drive.next(model.motor, speed));
    result.residual = std::max(result.residual, std::abs(stepper.energyResidual()));
    result.travel += std::abs(stepper.motorAngle() - angle);
    result.top_speed = std::max(result.top_speed, std::abs(stepper.speeds()[0]));
    result.reversals += speed * stepper.speeds()[0] < 0.0 ? 1 : 0;
    if (progress)
    {
      progress(static_cast<double>(i + 1) / static_cast<double>(steps));
    }
  }
  result.status = stepper.status();
  result.throughput = stepper.energyThroughput();
  return result;
}
}  // namespace hjt
