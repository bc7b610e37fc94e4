// SPDX-License-Identifier: BSD-3-Clause
// The twin driven by a measured motion, and what is identified from one. The robot measured is the twin itself, driven
// by a servo, with parameters that the identification does not know and with the noise of real sensors.
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "test_parameters.hpp"

#include "harmonic_joint_twin/twin/twin.hpp"
#include "identification/identification.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
namespace
{
TEST(MotionDifferentiator, KeepsToAParabolaThroughJitterRepeatsAndDropOuts)
{
  MotionDifferentiator smoother;
  std::mt19937 engine(11);
  std::vector<MotionSample> samples;
  const auto collect = [&](bool at_end)
  {
    while (const auto sample = smoother.pop(at_end))
    {
      samples.push_back(*sample);
    }
  };
  const auto angle = [](double time) { return 0.3 + 0.7 * time - 0.9 * time * time; };
  for (int i = 0; i < 500; ++i)
  {
    if (engine() % 100 == 0)
    {
      continue;  // dropped
    }
    const double time = 0.008 * i + 0.003 * static_cast<double>(engine() % 1000) / 1000.0 + (i >= 250 ? 1.0 : 0.0);
    EXPECT_TRUE(smoother.push({ time, angle(time), 0.0, 0.0 }));
    EXPECT_FALSE(smoother.push({ time, 1.0, 0.0, 0.0 }));  // its stamp repeated
    collect(false);
  }
  constexpr double NONE = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(smoother.push({ NONE, 0.0, 0.0, 0.0 }));
  EXPECT_FALSE(smoother.push({ 1e3, NONE, 0.0, 0.0 }));
  EXPECT_FALSE(smoother.push({ 1e3, 0.0, NONE, 0.0 }));
  EXPECT_FALSE(smoother.push({ 1e3, 0.0, 0.0, NONE }));
  collect(true);
  EXPECT_EQ(smoother.gaps(), 1u);
  EXPECT_GT(samples.size(), 480u);
  int cuts = 0;
  for (const MotionSample& sample : samples)
  {
    cuts += sample.after_gap ? 1 : 0;
    EXPECT_NEAR(sample.velocity, 0.7 - 1.8 * sample.time, 1e-6);
    EXPECT_NEAR(sample.acceleration, -1.8, 1e-4);
  }
  EXPECT_EQ(cuts, 1);
}

TEST(MotionDifferentiator, TakesTwoRowsToEitherSideHoweverFarApart)
{
  MotionDifferentiator smoother;
  int samples = 0;
  for (int i = 0; i < 50; ++i)
  {
    const double time = 0.09 * i;
    smoother.push({ time, 0.3 + 0.7 * time - 0.9 * time * time, 0.0, 0.0 });
    while (const auto sample = smoother.pop())
    {
      if (samples > 0)  // the first has too few
      {
        EXPECT_NEAR(sample->velocity, 0.7 - 1.8 * sample->time, 1e-6);
        EXPECT_NEAR(sample->acceleration, -1.8, 1e-6);
      }
      ++samples;
    }
  }
  EXPECT_EQ(samples, 48);
}
}  // namespace
}  // namespace hjt
