// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/ros_io/twin_loop.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "harmonic_joint_twin/ros_io/time.hpp"

namespace hjt
{
namespace
{
using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// Of the loop, by the wall clock.
constexpr milliseconds CYCLE_PERIOD{ 1 };
/// Simulated at most in one cycle, so that the loop stays responsive while it catches up [ns].
constexpr Stamp LONGEST_CATCH_UP = 20'000'000;
/// A smaller step back, as time synchronisation makes, is waited out [ns].
constexpr Stamp CLOCK_JUMP_TOLERANCE = 100'000'000;
/// How long a request waits for the loop.
constexpr milliseconds REQUEST_TIMEOUT{ 2000 };
}  // namespace

TwinLoop::TwinLoop(Twin& twin, Inbox& inbox, Clock clock, AfterStep after_step)
  : twin_(twin)
  , inbox_(inbox)
  , clock_(std::move(clock))
  , after_step_(std::move(after_step))
  , hold_back_(toStampLength(twin.parameters().input.hold_back))
  , wait_for_first_input_(twin.parameters().input.wait_for_first_input)
  , arrived_(Inbox::makeBuffer())
  , waiting_(Inbox::makeBuffer())
  , thread_([this] { run(); })
{
}

TwinLoop::~TwinLoop()
{
  stopping_ = true;
  thread_.join();
}

bool TwinLoop::reset()
{
  const std::uint64_t request = ++resets_requested_;
  const auto deadline = steady_clock::now() + REQUEST_TIMEOUT;
  while (resets_done_ < request && steady_clock::now() < deadline)
  {
    std::this_thread::sleep_for(CYCLE_PERIOD);
  }
  return resets_done_ >= request;
}

void TwinLoop::run()
{
  auto deadline = steady_clock::now();
  while (!stopping_)
  {
    const auto begin = steady_clock::now();
    cycle();
    const auto end = steady_clock::now();
    if (end - begin > CYCLE_PERIOD)
    {
      ++status_.overruns;
    }
    ++status_.cycles;
    shown_status_.tryWrite(status_);
    deadline = std::max(deadline + CYCLE_PERIOD, end);
    if (status_.lag < LONGEST_CATCH_UP)
    {
      std::this_thread::sleep_until(deadline);
    }
  }
}

void TwinLoop::cycle() noexcept
{
  // Without a time there is nothing to start anew, and inputs cannot be put in order yet.
  if (clock_() == 0)
  {
    resets_done_ = resets_requested_.load();
    return;
  }
  // The inputs first, then the clock: what came after a jump back is not mistaken for what came before it.
  inbox_.take(arrived_);
  readClock(clock_());
  const Stamp limit = std::max<Stamp>(status_.clock - hold_back_, 0);
  answerRequests(limit);
  sortInputs();
  if (status_.state == LoopState::RUNNING || tryStart(limit))
  {
    catchUp(limit);
  }
  status_.twin_stamp = twin_.stamp();
  status_.outputs = twin_.outputs();
  status_.counters = twin_.counters();
}

void TwinLoop::readClock(Stamp now) noexcept
{
  if (now + CLOCK_JUMP_TOLERANCE < status_.clock)
  {
    ++status_.clock_jumps;
    status_.state = LoopState::WAITING_FOR_CLOCK;
    status_.clock = now;
    status_.lag = 0;
    waiting_.clear();
  }
  status_.clock = std::max(status_.clock, now);
}

void TwinLoop::answerRequests(Stamp limit) noexcept
{
  const std::uint64_t requested = resets_requested_;
  if (requested != resets_done_)
  {
    waiting_.clear();
    start(limit);
    ++status_.resets;
    resets_done_ = requested;
  }
}

void TwinLoop::sortInputs() noexcept
{
  for (Input& input : arrived_)
  {
    // Stamped before there was a time: as good as now.
    if (input.stamp == 0)
    {
      input.stamp = status_.clock;
    }
    if (status_.state == LoopState::RUNNING)
    {
      handOver(input);
    }
    else if (waiting_.size() < Inbox::CAPACITY)
    {
      waiting_.push_back(input);
    }
    else
    {
      ++status_.waiting_overflow;
    }
  }
}

bool TwinLoop::tryStart(Stamp limit) noexcept
{
  if (!wait_for_first_input_)
  {
    start(status_.clock);
    return true;
  }
  // Several topics may bring the first input, in any order: the earliest stamp counts once the clock has passed it.
  status_.state = LoopState::WAITING_FOR_INPUT;
  Stamp first = std::numeric_limits<Stamp>::max();
  for (const Input& input : waiting_)
  {
    if (input.kind == InputKind::MOTOR_TORQUE || input.kind == InputKind::LOAD_TORQUE)
    {
      first = std::min(first, input.stamp);
    }
  }
  if (first > limit)
  {
    return false;
  }
  start(first);
  return true;
}

void TwinLoop::start(Stamp stamp) noexcept
{
  twin_.reset(stamp);
  status_.state = LoopState::RUNNING;
  status_.largest_lag = 0;
  status_.command_seen = false;
  for (Input& input : waiting_)
  {
    // The twin was not there yet when these were due: they act from its first instant and are not late.
    input.stamp = std::max(input.stamp, stamp);
    handOver(input);
  }
  waiting_.clear();
}

void TwinLoop::handOver(const Input& input) noexcept
{
  twin_.give(input);
  if (input.kind == InputKind::MOTOR_TORQUE)
  {
    status_.last_command = status_.command_seen ? std::max(status_.last_command, input.stamp) : input.stamp;
    status_.command_seen = true;
  }
}

void TwinLoop::catchUp(Stamp limit) noexcept
{
  const Stamp until = std::min(limit, twin_.stamp() + LONGEST_CATCH_UP);
  while (twin_.step(until))
  {
    after_step_(twin_);
  }
  status_.lag = std::max<Stamp>(limit - twin_.stamp(), 0);
  status_.largest_lag = std::max(status_.largest_lag, status_.lag);
}
}  // namespace hjt
