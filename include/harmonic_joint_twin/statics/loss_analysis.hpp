// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"

namespace hjt
{
/// Parts of the friction, each as a torque at the motor shaft, averaged over a tooth pitch [N.m].
struct LossShares
{
  double bearing{};  ///< of the wave generator, Palmgren
  double interface {
  };                 ///< outer race in the rim
  double flexing{};  ///< steel of the rim, bent twice a turn
  double mesh{};     ///< tooth flanks
  double cup{};      ///< dry friction beside the cup's spring
  double damping{};  ///< dashpots of the ring
  double output{};   ///< dry friction of the output's bearing and seals
  double motor{};    ///< dry and viscous of the motor, and viscous of the output

  /// Loss of the gear with the output's bearing and seals.
  double gear() const { return bearing + interface + flexing + mesh + cup + damping + output; }
};

/// Steady turning at constant motor speed against a constant load.
struct LossRow
{
  SolveStatus status;     ///< of the ring; the numbers hold if ok()
  double motor_speed{};   ///< [rad/s]
  double load_torque{};   ///< at the output, > 0 resists [N.m]
  double load_reduced{};  ///< torque of the load at the motor without friction, mean of load x d(output)/d(motor) [N.m]
  LossShares loss;        ///< [N.m]
  double gear_efficiency{};  ///< load power over motor power, the motor's own friction left out; 0 without load [-]
};

/// One row for every speed [rad/s of the motor] and load [N.m at the output]: all speeds of the first load, then of the
/// next. Laws and sources: docs/model.md, Friction.
/// `positions`: wave generator angles per tooth pitch, >= 1. `progress`: called with the loads done.
/// @throws InputError if positions < 1.
std::vector<LossRow> analyseLosses(const Parameters& parameters, const std::vector<double>& speeds,
                                   const std::vector<double>& loads, int positions,
                                   const std::function<void(int)>& progress);

/// Torques at which the gear without its motor's own friction begins to move, at the temperature of the input section.
struct Breakaway
{
  SolveStatus status;     ///< of the ring; the numbers hold if ok()
  double starting{};      ///< at the wave generator, no load: the largest over a tooth pitch [N.m]
  double back_driving{};  ///< at the output, wave generator free: the load whose own pull overcomes the friction [N.m]
};
/// `positions`: as of analyseLosses. @throws InputError if positions < 1.
Breakaway analyseBreakaway(const Parameters& parameters, int positions);
}  // namespace hjt
