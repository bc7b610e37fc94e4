// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gear/angle.hpp"
#include "ring_fixture.hpp"

namespace hjt
{
/// A ring on its wave generator.
struct PlacedRing
{
  RingShape shape;
  DrivePosition position;
};

/// Rings pressed on a turned wave generator and shaken, each by another amplitude between 1 um and 0.1 mm: tooth points
/// inside and outside the wave generator, teeth open and on either flank.
class RandomRing : public SeededRandom
{
public:
  using SeededRandom::SeededRandom;

  PlacedRing draw(const RingModel& model)
  {
    const DrivePosition position{ uniform(-PI, PI), uniform(-PI, PI), uniform(0.5, 1.1) * model.gear.wave_amplitude };
    RingShape shape = model.restShape(position);  // every tooth out of contact and paired with its nearest space
    pressOnWaveGenerator(model.rest, position, uniform(-2e-3, 2e-3), shape);
    shake(std::pow(10.0, uniform(-6.0, -4.0)), *this, shape);
    model.of<ToothMesh>().pairNearest(position, shape);
    return { shape, position };
  }
};
}  // namespace hjt
