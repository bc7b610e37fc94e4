// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Motor with its drive: what of a commanded torque reaches the shaft.
///
/// The command is clamped at the torque limit. Towards the speed limit the torque that would speed the motor up further
/// fades out linearly over the last two per cent; braking torque is never held back.
class Motor
{
public:
  explicit Motor(const MotorParameters& parameters) : parameters_(parameters) {}

  struct Drive
  {
    double torque;  ///< at the shaft [N.m]
    bool clamped;   ///< the command exceeded the torque limit
    bool held;      ///< the speed limit held torque back
    double slope;   ///< how fast the torque falls with speed there, else 0 [N.m.s/rad]
  };
  Drive drive(double command, double speed) const noexcept;

  double inertia() const noexcept { return parameters_.rotor_inertia + parameters_.wave_generator_inertia; }
  double coulombTorque() const noexcept { return parameters_.coulomb_torque; }
  double viscousFriction() const noexcept { return parameters_.viscous_friction; }

private:
  MotorParameters parameters_;
};
}  // namespace hjt
