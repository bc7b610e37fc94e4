// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <gtest/gtest.h>

#include "solver/joint_stepper.hpp"

namespace hjt
{
/// A joint by itself, marched under inputs that are held.
struct SteppedJoint
{
  explicit SteppedJoint(const Parameters& given) : parameters(given), model(parameters), stepper(parameters, model)
  {
    inputs.temperature = parameters.input.temperature;
  }

  /// `before` each step: with its number, from 1 on.
  void run(
      int steps, const std::function<void(int step)>& before = [](int) {})
  {
    for (int i = 1; i <= steps; ++i)
    {
      before(i);
      ASSERT_TRUE(stepper.step(inputs)) << i;
    }
  }

  const Parameters parameters;
  const JointModel model;
  JointStepper stepper;
  JointInputs inputs;
};
}  // namespace hjt
