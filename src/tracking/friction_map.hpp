// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "elements/friction_laws.hpp"
#include "elements/motor.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Parts of a joint's friction in steady motion, each as a torque at the motor shaft, >= 0 [N.m].
struct FrictionShares
{
  double preload{};   ///< friction of the balls under the preload of the race; proportional to bearing.race_preload
  double grease{};    ///< bearing friction by speed; ~ bearing.viscosity^(2/3) for viscosity x speed > 2000 mm^2/s rpm
  double flanks{};    ///< friction of tooth flanks; proportional to mesh.friction_static and _kinetic together
  double rest{};      ///< friction of loaded bearing, outer race, rim and cup, Coulomb friction of motor and output
  double stribeck{};  ///< rise of the friction towards standstill; proportional to motor.stribeck_torque
  double viscous{};   ///< friction of motor and output proportional to the speed

  double sum() const noexcept { return preload + grease + flanks + rest + stribeck + viscous; }
};

/// Table of the twin's friction over speed and load. The full ring makes the table once, so that the twin can follow a
/// motion of hours in seconds.
///
/// The table has no errors of manufacture, which change the ripple of the friction, not its mean over a tooth pitch.
class FrictionMap
{
public:
  /// Makes the table in some ten milliseconds. The table covers loads up to the largest load that the motor can hold,
  /// or up to output.load_torque_limit if motor.torque_limit is 0. Beyond output.load_torque_limit the table ends at
  /// the first load under which the ring finds no equilibrium. @throws ParameterError if both limits are 0 or the ring
  /// finds no equilibrium under a smaller load.
  explicit FrictionMap(const Parameters& parameters);

  /// Friction at a motor speed [rad/s], output load [N.m] and temperature [degC]. For larger loads than those of the
  /// table the friction is that at the largest load.
  FrictionShares at(double motor_speed, double load, double temperature) const noexcept
  {
    return atViscosity(motor_speed, load, viscosity(temperature));
  }

  /// As at(), but for a viscosity [m^2/s] in place of a temperature. at() spends most of its time on the viscosity,
  /// which hardly changes from call to call.
  FrictionShares atViscosity(double motor_speed, double load, double viscosity) const noexcept;
  double viscosity(double temperature) const noexcept { return bearing_.viscosity(temperature); }

private:
  static constexpr std::size_t SPEEDS = 7;
  struct Line  // friction at one load
  {
    double load;                        // load at the output [N.m]
    double rest;                        // FrictionShares::rest [N.m]
    std::array<double, SPEEDS> flanks;  // FrictionShares::flanks at each speed [N.m]
  };

  BearingFriction bearing_;
  Motor motor_;
  double race_preload_;    // bearing.race_preload [N]
  double viscous_;         // viscous friction of motor and output at the motor shaft, per speed [N.m.s/rad]
  double preload_torque_;  // FrictionShares::preload [N.m]
  std::vector<Line> lines_;
};
}  // namespace hjt
