// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <random>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "model/joint_model.hpp"

namespace hjt
{
struct RandomDriveSettings
{
  unsigned seed{};
  double load{ 150.0 };  ///< largest, either way; by default the joint's rating [N.m]
  bool brake{ true };
};

/// Torques as a rough user gives them: every few hundredths of a second another motor torque within the limit, and now
/// and then another load, or the brake. The same seed gives the same torques at the same instants, whatever the step.
class RandomDrive
{
public:
  RandomDrive(const RandomDriveSettings& settings, const Parameters& parameters);

  /// For the next step, with the drive's limits at the present speed [rad/s].
  JointInputs next(const Motor& motor, double motor_speed);

private:
  std::mt19937 random_;
  double load_;  // [N.m]
  bool brake_;
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
  double top_speed{};   ///< of the motor [rad/s]
  int reversals{};      ///< of the motor
};

/// `duration` [s] from rest. `progress` gets the part done.
LedgerResult runLedger(const Parameters& parameters, const RandomDriveSettings& settings, double duration,
                       const std::function<void(double)>& progress = {});
}  // namespace hjt
