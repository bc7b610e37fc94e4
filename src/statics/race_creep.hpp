// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "solver/ring_equilibrium.hpp"

namespace hjt
{
/// How the outer race of the wave generator's bearing creeps round in the rim, and how far the two slip as it does.
///
/// The race rolls in the rim, pressed on at the lobes. Held, its surface would slip there at
///   q_i = l psi_i' - r eps_i + f - g_i                  [m/rad, by the wave generator's angle]
/// where  l      contact.slip_lever; psi_i' rate at which the chord at tooth i tilts, against the wave's turning [-]
///        r, eps_i  bore radius [m]; strain of the rim there [-]: the race does not stretch
///        f, g_i  raceFit; worn off rim and race [m]
/// Nothing holds it: the friction of the balls on it is a hundredth of that on the rim. It creeps at the rate c at
/// which friction loses least, where the forces of friction cancel: the median of q_i weighted by the normal forces.
/// Two surfaces that roll wear by sum F_i |q_i - c|, whatever c is.
class RaceCreep
{
public:
  explicit RaceCreep(const Parameters& parameters);

  /// By the wave generator's angle.
  struct Rates
  {
    double advance{};  ///< of the race's surface in the rim, the wave generator's way; 0 without contact [m/rad]
    double sliding{};  ///< normal force times slip, of the whole rim; friction coefficient left out [N.m/rad]
  };

  /// `running`: 2 N, rates of the ring's points by the motor angle, the output following [m/rad].
  Rates at(const RingEquilibrium& ring, const Eigen::VectorXd& running);

private:
  struct Slip
  {
    double rate;   // [m/rad]
    double force;  // [N]
  };

  double lever_;        // [m]
  double radius_;       // [m]
  double fit_;          // [m]
  double rest_length_;  // of a segment [m]
  std::vector<Slip> slips_;
};
}  // namespace hjt
