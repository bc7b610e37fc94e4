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

std::vector<double> popAll(InputQueue& queue, Stamp until = END)
{
  std::vector<double> values;
  Input input;
  while (queue.pop(until, input))
  {
    values.push_back(input.value);
  }
  return values;
}

TEST(InputQueue, GivesInputsInOrderOfTime)
{
  const auto queue = std::make_unique<InputQueue>();
  for (const Stamp stamp : { 30, 10, 50, 20, 40 })
  {
    queue->push(torque(stamp, static_cast<double>(stamp)), 0);
  }
  EXPECT_EQ(popAll(*queue), (std::vector<double>{ 10, 20, 30, 40, 50 }));
  EXPECT_TRUE(queue->empty());
  EXPECT_EQ(queue->counters().accepted, 5u);
  EXPECT_EQ(queue->counters().late, 0u);
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

TEST(InputQueue, HoldsBackWhatIsStampedAfterTheInstant)
{
  const auto queue = std::make_unique<InputQueue>();
  queue->push(torque(100, 1.0), 0);
  queue->push({ 200, InputKind::BRAKE, 1.0 }, 0);
  EXPECT_TRUE(popAll(*queue, 99).empty());
  EXPECT_EQ(popAll(*queue, 100), std::vector<double>{ 1.0 });
  Input input;
  EXPECT_FALSE(queue->pop(199, input));
  ASSERT_TRUE(queue->pop(200, input));
  EXPECT_EQ(input.kind, InputKind::BRAKE);
}

TEST(InputQueue, RefusesAndCountsWhatIsNotFinite)
{
  const auto queue = std::make_unique<InputQueue>();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double value : { std::numeric_limits<double>::quiet_NaN(), infinity, -infinity })
  {
    queue->push(torque(1, value), 0);
  }
  EXPECT_TRUE(queue->empty());
  EXPECT_EQ(queue->counters().not_finite, 3u);
  EXPECT_EQ(queue->counters().accepted, 0u);
}

TEST(InputQueue, CountsLateInputsAndGivesThemAtOnce)
{
  const auto queue = std::make_unique<InputQueue>();
  queue->push(torque(99, 1.0), 100);
  queue->push(torque(100, 2.0), 100);
  EXPECT_EQ(queue->counters().late, 1u);
  EXPECT_EQ(queue->counters().accepted, 2u);
  EXPECT_EQ(popAll(*queue, 100), (std::vector<double>{ 1.0, 2.0 }));
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
