// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "harmonic_joint_twin/twin/input_queue.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
constexpr Stamp END = std::numeric_limits<Stamp>::max();

Input torque(Stamp stamp, double value)
{
  return { stamp, InputKind::MOTOR_TORQUE, value };
}

std::vector<double> popAll(InputQueue& queue)
{
  std::vector<double> values;
  Input input;
  while (queue.pop(END, input))
  {
    values.push_back(input.value);
  }
  return values;
}

TEST(InputQueue, KeepsArrivalOrderOfEqualStampsOverManyTurnsOfItsStore)
{
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_int_distribution<Stamp> stamps(0, 50);
  const auto queue = std::make_unique<InputQueue>();
  for (int round = 0; round < 100; ++round)
  {
    std::vector<Input> sent(300);
    for (std::size_t i = 0; i < sent.size(); ++i)
    {
      sent[i] = torque(stamps(random), static_cast<double>(i));
      queue->push(sent[i], 0);
    }
    std::stable_sort(sent.begin(), sent.end(), [](const Input& a, const Input& b) { return a.stamp < b.stamp; });
    Input input;
    for (const Input& expected : sent)
    {
      ASSERT_TRUE(queue->pop(END, input));
      ASSERT_EQ(input.stamp, expected.stamp);
      ASSERT_EQ(input.value, expected.value);
    }
    ASSERT_FALSE(queue->pop(END, input));
  }
  EXPECT_EQ(queue->counters().accepted, 30000u);
  EXPECT_EQ(queue->counters().overflow, 0u);
}

TEST(InputQueue, DropsTheOldestWhenFull)
{
  const auto queue = std::make_unique<InputQueue>();
  const auto capacity = static_cast<Stamp>(InputQueue::CAPACITY);
  for (Stamp stamp = 0; stamp < capacity + 3; ++stamp)
  {
    queue->push(torque(stamp, static_cast<double>(stamp)), 0);
  }
  queue->push(torque(0, -1.0), 0);  // older than all that is held: itself the oldest
  EXPECT_EQ(queue->counters().overflow, 4u);
  EXPECT_EQ(queue->counters().accepted, InputQueue::CAPACITY + 3);
  const std::vector<double> values = popAll(*queue);
  ASSERT_EQ(values.size(), InputQueue::CAPACITY);
  EXPECT_EQ(values.front(), 3.0);
  EXPECT_EQ(values.back(), static_cast<double>(capacity + 2));
}

TEST(InputQueue, ForgetsInputsAndCountersWhenCleared)
{
  const auto queue = std::make_unique<InputQueue>();
  queue->push(torque(1, 1.0), 5);
  queue->push(torque(1, std::numeric_limits<double>::quiet_NaN()), 5);
  queue->clear();
  EXPECT_TRUE(queue->empty());
  EXPECT_TRUE(popAll(*queue).empty());
  EXPECT_EQ(queue->counters().accepted + queue->counters().not_finite + queue->counters().late, 0u);
}

TEST(InputQueue, DoesNotAllocate)
{
  const auto queue = std::make_unique<InputQueue>();
  const std::size_t before = allocationCount();
  Input input;
  for (Stamp stamp = 0; stamp < 3 * static_cast<Stamp>(InputQueue::CAPACITY); ++stamp)
  {
    queue->push(torque(stamp % 5000, 1.0), 100);
    if (stamp % 3 == 0)
    {
      queue->pop(stamp, input);
    }
  }
  EXPECT_EQ(allocationCount(), before);
}
}  // namespace
}  // namespace hjt
