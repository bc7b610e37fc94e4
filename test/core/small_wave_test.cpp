// SPDX-License-Identifier: BSD-3-Clause
// The ring on ever smaller waves.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "studies/small_wave.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
TEST(SmallWave, AmplitudesFallInEqualRatiosAndTheTheoriesComeTrue)
{
  constexpr int COUNT = 4;
  const Parameters parameters = goldenParameters();
  const double largest = parameters.gear.wave_amplitude;
  const double smallest = 1e-3 * largest;
  const std::vector<SmallWaveRow> rows = analyseSmallWave(parameters, WaveBending::PROPORTIONAL, smallest, COUNT);
  ASSERT_EQ(rows.size(), COUNT);
  for (int k = 0; k < COUNT; ++k)
  {
    const SmallWaveRow& row = rows[static_cast<std::size_t>(k)];
    ASSERT_TRUE(row.status.ok()) << k;
    EXPECT_NEAR(row.wave_amplitude, largest * std::pow(0.1, k), 1e-9 * largest) << k;
  }
  const SmallWaveRow& row = rows.back();
  for (const double error : { row.linear.radial, row.linear.tangential, row.linear.tilt })
  {
    EXPECT_LT(error, 2e-5);
  }
  for (const double error : { row.second_order.radial, row.second_order.tangential, row.second_order.tilt })
  {
    EXPECT_LT(error, 1e-7);
  }
  EXPECT_NEAR(analyseSmallWave(parameters, WaveBending::PROPORTIONAL, smallest, 1).front().wave_amplitude, largest,
              0.0);
}
}  // namespace
}  // namespace hjt
