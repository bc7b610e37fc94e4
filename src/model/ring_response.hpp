// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace hjt
{
/// Torques and stiffness of the ring in equilibrium at the joint's two angles, without friction.
struct RingResponse
{
  double energy{};                 ///< stored [J]
  double wave_generator_torque{};  ///< on the wave generator [N.m]
  double output_torque{};          ///< on the circular spline [N.m]
  double velocity_ratio{};         ///< output speed over motor speed at constant load [-]
  double output_stiffness{};       ///< of the output, the wave generator held [N.m/rad]
  double motor_stiffness{};        ///< of the wave generator, the output held [N.m/rad]
};

/// Friction of the ring in equilibrium, as it acts on the joint's two speeds.
struct RingFrictionResponse
{
  /// Loaded flanks that slide alike, taken together: sum_i |F_i| |slip_i . (motor, output speed)|, exact while all
  /// flanks of a group slide the same way.
  static constexpr int FLANK_GROUPS = 6;
  using Groups = Eigen::Array<double, FLANK_GROUPS, 1>;

  double contact_force{};     ///< sum over all teeth: load of the wave generator's bearing [N]
  double ring_torque{};       ///< at the motor shaft: outer race in the rim, flexing rim [N.m]
  Eigen::Vector3d viscous;    ///< dashpots: motor-motor, motor-output, output-output [N.m.s/rad]
  Groups flank_by_motor;      ///< sum of force times slip by motor angle [N.m]
  Groups flank_by_output;     ///< by output angle
  Groups rms_slip_by_motor;   ///< root mean square slip by motor angle [m/rad]
  Groups rms_slip_by_output;  ///< by output angle
};
}  // namespace hjt
