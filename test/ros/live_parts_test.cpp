// SPDX-License-Identifier: BSD-3-Clause
#include "live/twin_loop.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <thread>
#include <vector>

#include "live/thread_exchange.hpp"
#include "messages/conversions.hpp"
#include "messages/time.hpp"
#include "test/core/test_parameters.hpp"
#include "test/ros/twin_loop_support.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
TEST(LatencyHistogram, HoldsEveryLatencyInABinOfAnEighth)
{
  for (const Stamp latency : { Stamp{ 0 }, Stamp{ 1023 }, Stamp{ 1024 }, Stamp{ 1151 }, Stamp{ 1152 }, Stamp{ 999'999 },
                               5 * MILLISECOND, SECOND, 17 * SECOND })
  {
    LatencyHistogram histogram;
    histogram.add(latency);
    std::size_t bin = 0;
    while (histogram.bins()[bin] == 0)
    {
      ++bin;
    }
    EXPECT_LT(latency, LatencyHistogram::binEnd(bin));
    if (bin > 0)
    {
      EXPECT_GE(latency, LatencyHistogram::binEnd(bin - 1));
      EXPECT_LE(LatencyHistogram::binEnd(bin) * 8, LatencyHistogram::binEnd(bin - 1) * 9);
    }
  }
}

TEST(LatencyHistogram, KeepsWhatIsBeyondItsRangeInTheLastBin)
{
  LatencyHistogram histogram;
  histogram.add(std::numeric_limits<Stamp>::max());
  histogram.add(-1);
  EXPECT_EQ(histogram.bins().back(), 1U);
  EXPECT_EQ(histogram.bins().front(), 1U);
  EXPECT_EQ(histogram.largest(), std::numeric_limits<Stamp>::max());
}

TEST(LatencyHistogram, TellsQuantilesToTheEndOfTheirBin)
{
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0);
  for (int i = 1; i <= 1000; ++i)
  {
    histogram.add(i * MILLISECOND);
  }
  EXPECT_EQ(histogram.count(), 1000U);
  for (const double share : { 0.001, 0.5, 0.99, 0.999, 1.0 })
  {
    const double exact = share * static_cast<double>(SECOND);
    EXPECT_GE(static_cast<double>(histogram.quantile(share)), exact);
    EXPECT_LE(static_cast<double>(histogram.quantile(share)), 1.125 * exact);
  }
  EXPECT_EQ(histogram.quantile(1.0), SECOND);
}

TEST(Inbox, DropsWhatItCannotHoldAndCounts)
{
  Inbox inbox;
  for (std::size_t i = 0; i < Inbox::CAPACITY + 3; ++i)
  {
    inbox.push(Input{ static_cast<Stamp>(i), InputKind::MOTOR_TORQUE, 0.0 });
  }
  inbox.push(Input{ 0, InputKind::LOAD_TORQUE, std::numeric_limits<double>::infinity() });
  EXPECT_EQ(inbox.overflow(), 3U);
  EXPECT_EQ(inbox.notFinite(), 1U);
  EXPECT_TRUE(inbox.use(
      [](std::vector<LiveInput>& inputs)
      {
        ASSERT_EQ(inputs.size(), Inbox::CAPACITY);
        EXPECT_EQ(inputs.back().stamp(), static_cast<Stamp>(Inbox::CAPACITY) - 1);
        inputs.erase(inputs.begin() + 1, inputs.end());
      }));
  // What was left there goes on waiting.
  inbox.push(Input{ 7, InputKind::BRAKE, 1.0 });
  EXPECT_TRUE(inbox.use(
      [](const std::vector<LiveInput>& inputs)
      {
        ASSERT_EQ(inputs.size(), 2U);
        EXPECT_EQ(inputs.back().stamp(), 7);
      }));
}

TEST(SlotRing, HandsOverInOrderAndRefusesWhenFull)
{
  constexpr int MESSAGES = 100000;
  SlotRing<int> ring(8, 0);
  std::thread writer(
      [&]
      {
        for (int i = 0; i < MESSAGES;)
        {
          if (int* slot = ring.claim())
          {
            *slot = i++;
            ring.commit();
          }
          else
          {
            std::this_thread::yield();
          }
        }
      });
  int wrong = 0;
  for (int i = 0; i < MESSAGES;)
  {
    if (const int* slot = ring.front())
    {
      wrong += *slot == i++ ? 0 : 1;
      ring.pop();
    }
    else
    {
      std::this_thread::yield();
    }
  }
  writer.join();
  EXPECT_EQ(wrong, 0);
  for (int i = 0; i < 8; ++i)
  {
    ASSERT_NE(ring.claim(), nullptr);
    ring.commit();
  }
  EXPECT_EQ(ring.claim(), nullptr);
}
}  // namespace
}  // namespace hjt
