// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"

namespace hjt
{
/// Shares of the friction, each as a mean torque at the motor shaft over a tooth pitch [N.m].
struct LossShares
{
  double bearing{};  ///< rolling friction of the wave generator's bearing, by Palmgren's law
  double interface {
  };                 ///< friction of the outer race in the rim
  double flexing{};  ///< hysteresis of the rim's steel, which bends twice per turn
  double mesh{};     ///< friction of the tooth flanks
  double cup{};      ///< dry friction in parallel to the cup's spring
  double damping{};  ///< friction of the dashpots in the model's ring
  double output{};   ///< dry friction of the output's bearing and seals
  double motor{};    ///< dry and viscous friction of the motor, and viscous friction of the output

  /// Loss of the gear, including the output's bearing and seals.
  double gear() const { return bearing + interface + flexing + mesh + cup + damping + output; }
};

/// Losses at constant motor speed and constant load.
struct LossRow
{
  SolveStatus status;     ///< status of the ring's solve; the other numbers of the row are valid if ok()
  double motor_speed{};   ///< speed of the motor [rad/s]
  double load_torque{};   ///< load at the output, > 0 resists positive motion [N.m]
  double load_reduced{};  ///< torque of the load at the motor without friction: mean of load x d(output)/d(motor) [N.m]
  LossShares loss;        ///< shares of the friction [N.m]
  double gear_efficiency{};  ///< load power over motor power without the motor's own friction; 0 without load [-]
};

/// Returns one row for every pair of a motor speed [rad/s] and a load at the output [N.m]: all speeds for the first
/// load, then all speeds for the second load, and so on. Laws and sources: docs/model.md, Friction. `positions`: number
/// of wave generator angles in a tooth pitch, >= 1. The function calls `progress` with the number of finished loads.
/// @throws InputError if positions < 1.
std::vector<LossRow> analyseLosses(const Parameters& parameters, const std::vector<double>& speeds,
                                   const std::vector<double>& loads, int positions,
                                   const std::function<void(int)>& progress);

/// Torques at which the gear begins to move, without friction of the motor, at input.temperature.
struct Breakaway
{
  SolveStatus status;     ///< status of the ring's solve; the numbers are valid if ok()
  double starting{};      ///< largest torque at the wave generator over a tooth pitch, without load [N.m]
  double back_driving{};  ///< load at the output whose torque on the free wave generator overcomes the friction [N.m]
};
/// Computes Breakaway from `positions` wave generator angles in a tooth pitch. @throws InputError if positions < 1.
Breakaway analyseBreakaway(const Parameters& parameters, int positions);
}  // namespace hjt
