// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "harmonic_joint_twin/twin/twin.hpp"
#include "test/support/seeded_random.hpp"

namespace hjt
{
constexpr Stamp SECOND = 1000000000;
constexpr Stamp MILLISECOND = 1000000;

/// Of a twin or an arm.
template <class Stepped>
void advance(Stepped& stepped, Stamp until)
{
  while (stepped.step(until))
  {
  }
}

inline Stamp nextInstant(const Twin& twin)
{
  return twin.stamp() + twin.stepLength();
}

/// One step under these torques [N.m].
inline bool stepUnder(Twin& twin, double motor_torque, double load_torque)
{
  const Stamp next = nextInstant(twin);
  twin.commandMotorTorque(next, motor_torque);
  twin.commandLoadTorque(next, load_torque);
  return twin.step(next);
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
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// Stamped torques, loads and a brake at random times over `duration`, in order of time.
inline std::vector<Input> randomInputs(unsigned seed, Stamp duration, double motor, double load)
{
  SeededRandom random(seed);
  std::uniform_int_distribution<Stamp> pause(100000, 20 * MILLISECOND);
  std::vector<Input> inputs;
  for (Stamp stamp = 1; stamp < duration; stamp += pause(random))
  {
    const double choice = random.uniform();
    if (choice < 0.5)
    {
      inputs.push_back({ stamp, InputKind::MOTOR_TORQUE, motor * random.uniform() });
    }
    else if (choice < 0.9)
    {
      inputs.push_back({ stamp, InputKind::LOAD_TORQUE, load * random.uniform() });
    }
    else
    {
      inputs.push_back({ stamp, InputKind::BRAKE, random.uniform() < 0.0 ? 1.0 : 0.0 });
    }
  }
  return inputs;
}

inline void give(Twin& twin, const std::vector<Input>& inputs)
{
  for (const Input& input : inputs)
  {
    twin.push(input);
  }
}
}  // namespace hjt
