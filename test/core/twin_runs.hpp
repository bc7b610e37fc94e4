// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
constexpr Stamp SECOND = 1000000000;
constexpr Stamp MILLISECOND = 1000000;

inline void advance(Twin& twin, Stamp until)
{
  while (twin.step(until))
  {
  }
}

/// Outputs as a row of numbers, for comparison bit by bit; without the padding of the struct.
inline std::vector<double> numbers(const JointOutputs& o)
{
  return { static_cast<double>(o.stamp),
           o.motor_angle,
           o.motor_velocity,
           o.output_angle,
           o.output_velocity,
           o.motor_torque,
           o.load_torque,
           o.wave_generator_torque,
           o.joint_torque,
           o.friction_torque,
           o.torsional_stiffness,
           o.energy_residual,
           o.brake_engaged ? 1.0 : 0.0,
           o.converged ? 1. : 0.,
           static_cast<double>(o.iterations),
           o.residual };
}

inline bool allFinite(const std::vector<double>& values)
{
  for (const double value : values)
  {
    if (!std::isfinite(value))
    {
      return false;
    }
  }
  return true;
}

/// Stamped torques, loads and a brake at random times over `duration`, in order of time.
inline std::vector<Input> randomInputs(unsigned seed, Stamp duration, double motor, double load)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  std::uniform_int_distribution<Stamp> pause(100000, 20 * MILLISECOND);
  std::vector<Input> inputs;
  for (Stamp stamp = 1; stamp < duration; stamp += pause(random))
  {
    const double choice = part(random);
    if (choice < 0.5)
    {
      inputs.push_back({ stamp, InputKind::MOTOR_TORQUE, motor * part(random) });
    }
    else if (choice < 0.9)
    {
      inputs.push_back({ stamp, InputKind::LOAD_TORQUE, load * part(random) });
    }
    else
    {
      inputs.push_back({ stamp, InputKind::BRAKE, part(random) < 0.0 ? 1.0 : 0.0 });
    }
  }
  return inputs;
}

inline void give(Twin& twin, const Input& input)
{
  twin.push(input);
}
}  // namespace hjt
