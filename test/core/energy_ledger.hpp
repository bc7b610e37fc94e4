// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "model/joint_model.hpp"
#include "solver/joint_stepper.hpp"
#include "test/support/seeded_random.hpp"

namespace hjt
{
struct RandomDriveSettings
{
  unsigned seed{};
  double load{ 150.0 };  ///< largest, either way; by default the joint's rating [N.m]
};

/// Torques as a rough user gives them: every few hundredths of a second another motor torque within the limit, and now
/// and then another load, or the brake. The same seed gives the same torques at the same instants, whatever the step.
class RandomDrive
{
public:
  RandomDrive(const RandomDriveSettings& settings, const Parameters& parameters)
    : random_(settings.seed)
    , load_(settings.load)
    , rate_(parameters.solver.rate)
    , torque_limit_(parameters.motor.torque_limit)
  {
    inputs_.temperature = parameters.input.temperature;
  }

  /// For the next step.
  JointInputs next()
  {
    constexpr double MILLISECOND = 1e-3;  // all changes fall on whole ones, so that every step meets them
    constexpr double BRAKE_CHANCE = 0.2;
    if (left_-- == 0)
    {
      std::uniform_int_distribution<int> hold(10, 50);
      left_ = std::max(1, static_cast<int>(std::lround(rate_ * MILLISECOND * hold(random_)))) - 1;
      command_ = torque_limit_ * (2.0 * random_.uniform(0.0, 1.0) - 1.0);
      inputs_.load_torque =
          random_.uniform(0.0, 1.0) < 0.5 ? load_ * (2.0 * random_.uniform(0.0, 1.0) - 1.0) : inputs_.load_torque;
      inputs_.brake_engaged = random_.uniform(0.0, 1.0) < BRAKE_CHANCE;
    }
    inputs_.motor_torque = command_;
    return inputs_;
  }

private:
  SeededRandom random_;
  double load_;          // [N.m]
  double rate_;          // [Hz]
  double torque_limit_;  // [N.m]
  int left_{};           // steps to the next change
  double command_{};     // [N.m]
  JointInputs inputs_;
};

/// Energy balance of a random motion.
struct LedgerResult
{
  SolveStatus status;   ///< of the last step
  double throughput{};  ///< sum of |work| of motor, load and friction [J]
  double residual{};    ///< largest energy in - stored - dissipated on the way [J]
  double travel{};      ///< of the motor, both ways added [rad]
  int reversals{};      ///< of the motor
};

/// `duration` [s] from rest.
inline LedgerResult runLedger(const Parameters& parameters, const RandomDriveSettings& settings, double duration)
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
    converged = stepper.step(drive.next());
    result.residual = std::max(result.residual, std::abs(stepper.energyResidual()));
    result.travel += std::abs(stepper.motorAngle() - angle);
    result.reversals += speed * stepper.speeds()[0] < 0.0 ? 1 : 0;
  }
  result.status = stepper.status();
  result.throughput = stepper.energyThroughput();
  return result;
}
}  // namespace hjt
