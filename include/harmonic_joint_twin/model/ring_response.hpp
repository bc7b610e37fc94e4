// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

namespace hjt
{
/// What the joint feels of the ring in equilibrium at its two angles, friction apart.
struct RingResponse
{
  double energy{};                 ///< stored [J]
  double wave_generator_torque{};  ///< on the wave generator [N.m]
  double output_torque{};          ///< on the circular spline [N.m]
  double follow{};                 ///< output speed over motor speed at constant load [-]
  double output_stiffness{};       ///< of the output, the wave generator held [N.m/rad]
};

/// Loaded flanks that slide alike, taken together. The sums stand for sum_i |F_i| |slip_i . (motor, output speed)|: exact
/// while all flanks of the group slide the same way.
struct FlankGroup
{
  Eigen::Vector2d slip;      ///< sum of force times slip by motor and output angle [N.m]
  Eigen::Vector2d rms_slip;  ///< root mean square slip, by motor and output angle [m/rad]
};

/// Friction of the ring in equilibrium, as it acts on the joint's two speeds.
struct RingFrictionResponse
{
  static constexpr int FLANK_GROUPS = 4;

  double contact_force{};     ///< sum over all teeth: load of the wave generator's bearing [N]
  double interface_torque{};  ///< between outer race and rim [N.m]
  Eigen::Vector2d cup_slip;   ///< mean rotation of the rim by motor and output angle [-]
  Eigen::Vector3d viscous;    ///< dashpots: motor-motor, motor-output, output-output [N.m.s/rad]
  std::array<FlankGroup, FLANK_GROUPS> flanks;
};
}  // namespace hjt
