// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "model/ring_model.hpp"
#include "ring_fixture.hpp"

namespace hjt
{
/// Rings pressed on a turned wave generator and shaken, each by another amplitude between 1 um and 0.1 mm: tooth points
/// inside and outside the wave generator, teeth open and on either flank. The seed is printed with a failure.
class RandomRing
{
public:
  explicit RandomRing(unsigned seed) : random_(seed), trace_(__FILE__, __LINE__, "seed " + std::to_string(seed)) {}

  void draw(const RingModel& model, RingShape& shape, DrivePosition& position)
  {
    position = { uniform(-PI, PI), uniform(-PI, PI), uniform(0.5, 1.1) * model.gear.wave_amplitude };
    shape = model.restShape(position);  // every tooth out of contact and paired with its nearest space
    pressOnWaveGenerator(model.rest, position, uniform(-2e-3, 2e-3), shape);
    shake(std::pow(10.0, uniform(-6.0, -4.0)), random_, shape);
    model.of<ToothMesh>().pairNearest(position, shape);
  }

  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }

private:
  std::mt19937 random_;
  testing::ScopedTrace trace_;
};
}  // namespace hjt
