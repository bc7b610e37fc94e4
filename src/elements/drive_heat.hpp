// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Heat of the drive in two nodes: grease, with what turns and bends in it, and housing.
///
///   C_g dT_g/dt = P_f - G (T_g - T_h)
///   C_h dT_h/dt = P_m + P_0 + G (T_g - T_h) - G_a (T_h - T_a)
/// where P_f friction, P_m copper loss of the motor, P_0 standby power                                      [W]
///       C_g, C_h  heat capacities [J/K], G, G_a  conductances [W/K], T_a  temperature of the surroundings
///
/// A step is exact for constant powers and surroundings, whatever its length: the two modes of the symmetric problem in
/// sqrt(C) T relax on their own. Without losses to the surroundings (G_a = 0) the nodes keep all heat to rounding.
class DriveHeat
{
public:
  static constexpr double PERIOD = 0.1;  ///< over which the twin takes the mean of the losses [s]

  explicit DriveHeat(const ThermalParameters& parameters);

  /// Both nodes above the surroundings [degC] by the configured rise.
  void reset(double ambient) noexcept;

  /// Losses of a step [J].
  struct Losses
  {
    double friction{};
    double copper{};
  };

  /// Both nodes `seconds` later, in surroundings of `ambient` [degC].
  void advance(double seconds, const Losses& losses, double ambient) noexcept;

  /// The same where the housing's temperature is measured [degC]: only the grease is free.
  void advanceGrease(double seconds, double friction, double housing) noexcept;

  double grease() const noexcept { return grease_; }    ///< [degC]
  double housing() const noexcept { return housing_; }  ///< [degC]

private:
  ThermalParameters parameters_;
  Eigen::Vector2d root_;   // of both capacities [sqrt(J/K)]
  Eigen::Vector2d rates_;  // of the modes [1/s]
  Eigen::Matrix2d modes_;  // columns, orthonormal
  double grease_{};
  double housing_{};
};
}  // namespace hjt
