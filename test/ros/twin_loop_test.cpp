// SPDX-License-Identifier: BSD-3-Clause
#include "live/twin_loop.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "live/thread_exchange.hpp"
#include "messages/conversions.hpp"
#include "messages/time.hpp"
#include "test/core/test_parameters.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
constexpr Stamp MILLISECOND = 1'000'000;
constexpr Stamp SECOND = 1000 * MILLISECOND;
constexpr Stamp STEP = MILLISECOND;  // solver.rate 1000 Hz: the loop is under test here, not the solver
constexpr Stamp INPUT_DELAY = 20 * MILLISECOND;

struct Instant
{
  Stamp stamp;
  double motor_torque;
};

/// A loop on a clock that the test sets. Instants are kept by the loop's thread and read once it has come to rest.
class LoopFixture : public testing::Test
{
protected:
  void start(bool wait_for_first_input, ClockKind clock_kind = ClockKind::STEPPED)
  {
    const std::string wait = wait_for_first_input ? "true" : "false";
    twin_ = std::make_unique<Twin>(shippedParameters({ "solver.rate=1000", "indicators.sample_rate=1000",
                                                       "input.delay=0.02", "input.wait_for_first_input=" + wait }));
    instants_.reserve(1 << 20);
    advanced_ = std::make_unique<AdvancedTwin>(*twin_);
    loop_ = std::make_unique<TwinLoop>(
        *advanced_, twin_->parameters(), inbox_, [this] { return clock_.load(); }, clock_kind,
        [this] {
          instants_.push_back({ twin_->outputs().stamp, twin_->outputs().motor_torque });
        });
  }

  /// Sets the clock and waits until the loop has done all it may do at that time.
  void setClock(Stamp clock)
  {
    clock_ = clock;
    waitForCycles(2);
    waitFor([this] { return loop_->status().lag < STEP; });
    waitForCycles(2);
  }

  /// Far behind a clock that takes its longest steps, one after the other.
  void fallBehind()
  {
    for (int step = 0; step < 200; ++step)
    {
      clock_ = clock_ + TwinLoop::MAX_CLOCK_STEP;
      waitForCycles(2);
    }
    ASSERT_EQ(loop_->status().clock_jumps, 0U);
    ASSERT_GT(loop_->status().lag, 100 * SECOND);
  }

  void waitForCycles(std::uint64_t cycles)
  {
    const std::uint64_t first = loop_->status().cycles;
    waitFor([&] { return loop_->status().cycles >= first + cycles; });
  }

  template <class Condition>
  void waitFor(Condition condition)
  {
    const char* factor = std::getenv("HJT_PATIENCE");
    const std::chrono::seconds patience{ 30 * (factor != nullptr ? std::atoi(factor) : 1) };
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (!condition())
    {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "the loop did not get there";
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  std::atomic<Stamp> clock_{ 0 };
  Inbox inbox_;
  std::unique_ptr<Twin> twin_;
  std::unique_ptr<AdvancedTwin> advanced_;
  std::vector<Instant> instants_;
  std::unique_ptr<TwinLoop> loop_;
};

TEST_F(LoopFixture, VisitsEveryInstantAfterAJumpForwardAndNoneWhileTheClockStands)
{
  start(false);
  setClock(100 * SECOND);
  setClock(103 * SECOND);
  const std::size_t visited = instants_.size();
  ASSERT_EQ(visited, static_cast<std::size_t>((3 * SECOND - INPUT_DELAY) / STEP));
  for (std::size_t i = 1; i < visited; ++i)
  {
    ASSERT_EQ(instants_[i].stamp - instants_[i - 1].stamp, STEP);
  }
  EXPECT_GT(loop_->status().largest_lag, SECOND);
  EXPECT_GT(loop_->status().timing.lateness.count(), 0U);
  EXPECT_EQ(loop_->status().timing.lateness.largest(), 0) << "a simulated clock may step as far as it likes";
  waitForCycles(20);
  EXPECT_EQ(instants_.size(), visited);
}

TEST_F(LoopFixture, StartsAtTheEarliestStampInWhateverOrderTheFirstInputsArrive)
{
  start(true);
  setClock(100 * SECOND);
  inbox_.push(Input{ 100 * SECOND + 8 * MILLISECOND, InputKind::MOTOR_TORQUE, 0.5 });
  inbox_.push(Input{ 100 * SECOND + 4 * MILLISECOND, InputKind::LOAD_TORQUE, 1.0 });
  setClock(100 * SECOND + 10 * MILLISECOND);
  EXPECT_EQ(loop_->status().state, LoopState::WAITING_FOR_INPUT);
  EXPECT_TRUE(instants_.empty());
  setClock(100 * SECOND + 60 * MILLISECOND);
  ASSERT_EQ(instants_.size(), 36U);
  EXPECT_EQ(instants_.front().stamp, 100 * SECOND + 4 * MILLISECOND + STEP);
  EXPECT_EQ(loop_->status().counters.input.late, 0U);
}

TEST_F(LoopFixture, DoesNotStartOnABrakeOrANumberThatIsNone)
{
  start(true);
  inbox_.push(Input{ 100 * SECOND, InputKind::BRAKE, 1.0 });
  inbox_.push(Input{ 100 * SECOND, InputKind::MOTOR_TORQUE, std::nan("") });
  setClock(101 * SECOND);
  EXPECT_EQ(loop_->status().state, LoopState::WAITING_FOR_INPUT);
  EXPECT_EQ(inbox_.notFinite(), 1U);
  inbox_.push(Input{ 101 * SECOND, InputKind::MOTOR_TORQUE, 0.1 });
  setClock(102 * SECOND);
  EXPECT_TRUE(loop_->status().outputs.brake_engaged) << "a brake engaged before the start was forgotten";
  EXPECT_EQ(loop_->status().counters.input.late, 0U);
}

TEST_F(LoopFixture, StartsAnewWhenTheClockJumpsBackButNotOnASmallStepBack)
{
  start(false);
  setClock(100 * SECOND);
  setClock(101 * SECOND);
  const std::size_t visited = instants_.size();
  setClock(101 * SECOND - 50 * MILLISECOND);
  EXPECT_EQ(loop_->status().clock_jumps, 0U);
  EXPECT_EQ(instants_.size(), visited);
  setClock(50 * SECOND);
  setClock(51 * SECOND);
  EXPECT_EQ(loop_->status().clock_jumps, 1U);
  ASSERT_GT(instants_.size(), visited);
  EXPECT_EQ(instants_[visited].stamp, 50 * SECOND + STEP);
  EXPECT_EQ(loop_->status().counters.steps, instants_.size() - visited);
}

TEST_F(LoopFixture, StartsAnewWhenTheClockJumpsAheadButNotOnALongStep)
{
  start(false);
  setClock(100 * SECOND);
  setClock(100 * SECOND + TwinLoop::MAX_CLOCK_STEP);
  EXPECT_EQ(loop_->status().clock_jumps, 0U);
  std::size_t visited = static_cast<std::size_t>((TwinLoop::MAX_CLOCK_STEP - INPUT_DELAY) / STEP);
  ASSERT_EQ(instants_.size(), visited);
  std::uint64_t jumps = 0;
  for (const Stamp ahead : { TwinLoop::MAX_CLOCK_STEP + STEP, 1'000'000 * SECOND, 2'147'483'648 * SECOND })
  {
    const Stamp from = clock_;
    setClock(from + ahead);
    setClock(from + ahead + SECOND);
    EXPECT_EQ(loop_->status().clock_jumps, ++jumps);
    EXPECT_EQ(loop_->status().last_jump, ahead);
    ASSERT_EQ(instants_.size() - visited, static_cast<std::size_t>((SECOND - INPUT_DELAY) / STEP));
    EXPECT_EQ(instants_[visited].stamp, from + ahead + STEP);
    visited = instants_.size();
  }
}

/// Neither by the clock that it reads while a callback holds the inbox.
TEST_F(LoopFixture, DoesNotRunThroughTheTimeOfAJumpWhileItsInboxIsHeld)
{
  start(true);
  setClock(100 * SECOND);
  inbox_.push(Input{ 100 * SECOND, InputKind::MOTOR_TORQUE, 0.1 });
  setClock(101 * SECOND);
  ASSERT_EQ(loop_->status().state, LoopState::RUNNING);
  const std::size_t visited = instants_.size();
  while (!inbox_.use(
      [this](auto& /*inputs*/)
      {
        clock_ = 100'000 * SECOND;
        waitForCycles(5);
      }))
  {
  }
  setClock(100'001 * SECOND);
  EXPECT_EQ(instants_.size(), visited);
  EXPECT_EQ(loop_->status().clock_jumps, 1U);
  EXPECT_EQ(loop_->status().state, LoopState::WAITING_FOR_INPUT);
}

/// Whose steps take far longer than they simulate.
class SlowTwin : public AdvancedTwin
{
public:
  SlowTwin(Twin& twin, std::chrono::milliseconds length) : AdvancedTwin(twin), length_(length) {}

  bool step(Stamp until) noexcept override
  {
    const bool stepped = AdvancedTwin::step(until);
    if (stepped)
    {
      std::this_thread::sleep_for(length_);
    }
    return stepped;
  }

private:
  std::chrono::milliseconds length_;
};

TEST_F(LoopFixture, AnswersWithinAMomentHoweverSlowTheSolver)
{
  for (const int milliseconds : { 20, 150 })
  {
    Twin twin(shippedParameters({ "solver.rate=1000", "indicators.sample_rate=1000" }));
    SlowTwin slow(twin, std::chrono::milliseconds(milliseconds));
    Inbox inbox;
    clock_ = 100 * SECOND;
    TwinLoop loop(
        slow, twin.parameters(), inbox, [this] { return clock_.load(); }, ClockKind::STEPPED, [] {});
    waitFor([&] { return loop.status().state == LoopState::RUNNING; });
    clock_ = 105 * SECOND;
    waitFor([&] { return loop.status().lag > SECOND && loop.status().cycles > 5; });
    EXPECT_LT(loop.status().timing.longest_cycle, 60 * milliseconds * MILLISECOND / 3);
    EXPECT_TRUE(loop.reset());
    waitFor([&] { return loop.status().lag < STEP; });
  }
}

TEST_F(LoopFixture, ResetStartsAnewAtTheCurrentInstantAndGivesUpALag)
{
  start(false);
  setClock(100 * SECOND);
  fallBehind();
  ASSERT_TRUE(loop_->reset());
  waitFor([this] { return loop_->status().lag < STEP; });
  waitForCycles(2);
  EXPECT_EQ(loop_->status().twin_stamp, clock_ - INPUT_DELAY);
  EXPECT_EQ(loop_->status().resets, 1U);
}

/// While it catches up it does not sleep, and it does not sleep longer afterwards either.
TEST_F(LoopFixture, AnswersAtOnceAfterItHasCaughtUp)
{
  start(false);
  setClock(100 * SECOND);
  fallBehind();
  waitForCycles(5000);  // at rest each takes far less than 1 ms
  ASSERT_TRUE(loop_->reset());
  EXPECT_TRUE(loop_->reset());
}

TEST_F(LoopFixture, CountsMissedDeadlinesOfAClockThatRunsUntilAReset)
{
  start(false, ClockKind::RUNNING);
  setClock(100 * SECOND);
  setClock(100 * SECOND + INPUT_DELAY + 5 * MILLISECOND);
  EXPECT_EQ(loop_->status().timing.lateness.largest(), 4 * MILLISECOND) << "the oldest of five instants";
  EXPECT_EQ(loop_->status().timing.missed_deadlines, 0U) << "4 ms late are within 5 ms";
  setClock(103 * SECOND);
  const LoopTiming timing = loop_->status().timing;
  EXPECT_EQ(timing.lateness.largest(), 3 * SECOND - INPUT_DELAY - 6 * MILLISECOND);
  EXPECT_GE(timing.missed_deadlines, 47U) << "one a cycle of 60 ms, until it has caught up";
  EXPECT_EQ(timing.simulated, 3 * SECOND - INPUT_DELAY);
  EXPECT_GT(timing.wake_up.count(), 0U);
  EXPECT_GT(timing.longest_cycle, 0);
  EXPECT_GT(timing.load(), 0.0);
  ASSERT_TRUE(loop_->reset());
  waitForCycles(2);
  EXPECT_EQ(loop_->status().timing.missed_deadlines, 0U);
  EXPECT_EQ(loop_->status().timing.lateness.count(), 0U);
}

/// It sleeps while nobody awaits an instant, misses no deadline by that, and simulates every instant all the same.
TEST_F(LoopFixture, SleepsUntilTheNextInstantThatIsAwaited)
{
  const auto start_time = std::chrono::steady_clock::now();
  const auto clock = [start_time]
  {
    return 100 * SECOND +
           std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start_time).count();
  };
  std::atomic<Stamp> period{ SECOND };
  Twin twin(shippedParameters(
      { "solver.rate=1000", "indicators.sample_rate=1000", "input.delay=0.02", "realtime.deadline=1.0" }));
  instants_.reserve(1 << 20);
  AdvancedTwin advanced(twin);
  TwinLoop loop(
      advanced, twin.parameters(), inbox_, clock, ClockKind::RUNNING,
      [this, &twin] {
        instants_.push_back({ twin.stamp(), 0.0 });
      },
      [&period](Stamp instant) { return (instant / period + 1) * period; });
  const auto cycles_in_a_second = [&loop]
  {
    const std::uint64_t before = loop.status().cycles;
    std::this_thread::sleep_for(std::chrono::seconds(1));
    return loop.status().cycles - before;
  };
  waitFor([&loop] { return loop.status().state == LoopState::RUNNING; });
  EXPECT_LT(cycles_in_a_second(), 40U);
  EXPECT_LT(loop.status().timing.lateness.quantile(0.1), 8 * MILLISECOND) << "a sleep counted as late";
  EXPECT_EQ(loop.status().timing.missed_deadlines, 0U);
  period = MILLISECOND;
  EXPECT_GT(cycles_in_a_second(), 100U) << "every 4 ms";
  ASSERT_TRUE(loop.reset());
  ASSERT_GT(instants_.size(), 1500U);
  for (std::size_t i = 1; i < 1500; ++i)
  {
    ASSERT_EQ(instants_[i].stamp - instants_[i - 1].stamp, STEP);
  }
}

TEST_F(LoopFixture, RefusesInputsStampedFarFromTheClock)
{
  start(false);
  setClock(100'000 * SECOND);
  waitForCycles(2);
  for (const Stamp stamp : { Stamp{ 1 }, 100'000 * SECOND + FAR_STAMP + 60 * SECOND, LAST_ROS_STAMP })
  {
    inbox_.push(Input{ stamp, InputKind::MOTOR_TORQUE, 0.5 });
  }
  inbox_.push(Input{ 100'001 * SECOND, InputKind::MOTOR_TORQUE, 0.25 });
  waitForCycles(2);
  setClock(100'002 * SECOND);
  waitFor([this] { return loop_->status().counters.input.accepted == 1; });
  EXPECT_EQ(loop_->status().far_stamps, 3U);
  EXPECT_EQ(loop_->status().last_command, 100'001 * SECOND);
}

TEST_F(LoopFixture, OutlivesAClockThatJumpsToTheEndOfTimeAndBack)
{
  start(false);
  for (const Stamp far : { Stamp{ 1 }, 2'147'483'648 * SECOND, LAST_ROS_STAMP })
  {
    clock_ = far;
    waitForCycles(3);
    setClock(100 * SECOND);
    waitForCycles(3);
    EXPECT_EQ(loop_->status().state, LoopState::RUNNING);
    EXPECT_EQ(loop_->status().clock, 100 * SECOND);
  }
}

TEST_F(LoopFixture, AllocatesNothingOnceItRuns)
{
  start(false);
  SlotRing<harmonic_joint_twin::ContactForces> ring(4, makeContactForces(twin_->parameters()));
  setClock(100 * SECOND);
  loop_ = nullptr;
  loop_ = std::make_unique<TwinLoop>(
      *advanced_, twin_->parameters(), inbox_, [this] { return clock_.load(); }, ClockKind::STEPPED,
      [&]
      {
        if (auto* message = ring.claim())
        {
          if (fillContactForces(*twin_, 0, *message))
          {
            ring.commit();
            ring.pop();
          }
        }
      });
  setClock(101 * SECOND);
  for (int i = 0; i < 100; ++i)
  {
    inbox_.push(Input{ 101 * SECOND + i * MILLISECOND, InputKind::MOTOR_TORQUE, 0.5 });
  }
  const std::size_t before = allocationCount();
  clock_ = 102 * SECOND;
  waitForCycles(2);
  waitFor([this] { return loop_->status().lag < STEP; });
  EXPECT_EQ(allocationCount(), before);
  EXPECT_EQ(loop_->status().counters.steps, static_cast<std::uint64_t>((SECOND - INPUT_DELAY) / STEP));
}

/// More of one kind than the inbox holds do not keep out the torque that the twin waits for; the last of them acts.
TEST_F(LoopFixture, StartsHoweverMuchCameBeforeItsFirstTorque)
{
  start(true);
  setClock(100 * SECOND);
  for (int second = 100; second < 104; ++second)
  {
    for (int i = 0; i < static_cast<int>(Inbox::CAPACITY / 2); ++i)
    {
      inbox_.push(Input{ second * SECOND + i, InputKind::BRAKE, i % 2 == 0 ? 0.0 : 1.0 });
    }
    setClock((second + 1) * SECOND);
  }
  EXPECT_EQ(loop_->status().state, LoopState::WAITING_FOR_INPUT);
  inbox_.push(Input{ 104 * SECOND, InputKind::MOTOR_TORQUE, 0.1 });
  setClock(105 * SECOND);
  EXPECT_EQ(inbox_.overflow(), 0U);
  EXPECT_EQ(loop_->status().state, LoopState::RUNNING);
  EXPECT_TRUE(loop_->status().outputs.brake_engaged);
}

/// Inputs that arrived before a reset are forgotten while the twin waits for its first torque.
TEST_F(LoopFixture, AResetForgetsWhatWaitsForTheStart)
{
  start(true);
  setClock(100 * SECOND);
  inbox_.push(Input{ 100 * SECOND, InputKind::BRAKE, 1.0 });
  setClock(101 * SECOND);
  EXPECT_EQ(loop_->status().state, LoopState::WAITING_FOR_INPUT);
  ASSERT_TRUE(loop_->reset());
  setClock(102 * SECOND);
  EXPECT_FALSE(loop_->status().outputs.brake_engaged);
}

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
