// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// Control of one joint, all seen from the joint.
struct JointGains
{
  double position{};       ///< speed wanted for an error of the angle [1/s]
  double speed{};          ///< torque for an error of the speed [N.m.s/rad]
  double integral_time{};  ///< of the speed control [s]
  double coulomb{};        ///< friction that is fed forward: constant [N.m]
  double viscous{};        ///< and by speed [N.m.s/rad]
};
}  // namespace hjt
