// SPDX-License-Identifier: BSD-3-Clause
#include "live/twin_loop.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <utility>

#include <pthread.h>
#include <sys/prctl.h>

namespace hjt
{
namespace
{
using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// Period of the loop in wall clock time.
constexpr milliseconds CYCLE_PERIOD{ 1 };
/// Upper limit of shortestPause. A sleep collects the messages of several instants, so that threads wake less often
/// than once at every instant.
constexpr milliseconds SHORT_PAUSE{ 4 };
/// Longest sleep while no output is due. The sleep delays the answer to a user's request.
constexpr milliseconds MAX_PAUSE{ 50 };
/// Largest simulated time in one cycle [ns]. The limit exceeds MAX_PAUSE, so that a late loop catches up.
constexpr Stamp MAX_CATCH_UP = 60'000'000;
/// Wall clock time after which a cycle begins no further step, so that a slow solver does not delay requests.
constexpr milliseconds LONGEST_WORK{ 100 };
/// Largest backward step of the clock that counts as time synchronisation [ns]. After the step the loop waits.
constexpr Stamp CLOCK_JUMP_TOLERANCE = 100'000'000;
/// Longest time for which a request of a user waits for the loop.
constexpr milliseconds REQUEST_TIMEOUT{ 2000 };
/// Size of the stack that the loop may use [bytes].
constexpr std::size_t STACK_SIZE = 256 * 1024;

Stamp nanoseconds(steady_clock::duration duration)
{
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

/// Shortest pause between two cycles: a fifth of the twin's delay, from CYCLE_PERIOD to SHORT_PAUSE.
steady_clock::duration shortestPause(Stamp input_delay)
{
  constexpr int SHARE = 5;
  return std::clamp<steady_clock::duration>(input_delay / SHARE / nanoseconds(CYCLE_PERIOD) * CYCLE_PERIOD,
                                            CYCLE_PERIOD, SHORT_PAUSE);
}

/// Touches all pages of the stack, so that the pages are in memory before the first cycle.
__attribute__((noinline)) void touchStack()
{
  std::array<volatile char, STACK_SIZE> stack;
  constexpr std::size_t PAGE = 4096;
  for (std::size_t byte = 0; byte < stack.size(); byte += PAGE)
  {
    stack[byte] = 0;
  }
}

void prepareThread()
{
  pthread_setname_np(pthread_self(), "twin_loop");
  // Linux may let a thread without real-time priority sleep 50 us longer than requested.
  prctl(PR_SET_TIMERSLACK, 1UL);
  touchStack();
}
}  // namespace

TwinLoop::TwinLoop(Advanced& twin, const Parameters& parameters, Inbox& inbox, Clock clock, ClockKind clock_kind,
                   AfterStep after_step, AfterCycle after_cycle)
  : twin_(twin)
  , inbox_(inbox)
  , clock_(std::move(clock))
  , clock_kind_(clock_kind)
  , after_step_(std::move(after_step))
  , after_cycle_(std::move(after_cycle))
  , input_delay_(toStampLength(parameters.input.delay))
  , shortest_pause_(after_cycle_ ? shortestPause(input_delay_) : CYCLE_PERIOD)
  , deadline_(toStampLength(parameters.realtime.deadline))
  , step_length_(toStampLength(1.0 / parameters.solver.rate))
  , wait_for_first_input_(parameters.input.wait_for_first_input)
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
  prepareThread();
  auto wake_up = steady_clock::now();
  while (!stopping_)
  {
    const auto begin = steady_clock::now();
    cycle(begin);
    const auto end = steady_clock::now();
    keepTimes(begin, end);
    shown_status_.tryWrite(status_);
    // Cycles without sleep while the loop catches up do not prolong the next sleep.
    const auto length = pause(after_cycle_ ? after_cycle_(twin_.stamp()) : twin_.stamp());
    wake_up = status_.lag < MAX_CATCH_UP ? std::max(wake_up + length, end) : end;
    if (wake_up > end)
    {
      // Instants without output are due at the end of the sleep.
      if (length > CYCLE_PERIOD)
      {
        released_ = std::max(released_, status_.clock + nanoseconds(wake_up - begin - CYCLE_PERIOD));
      }
      std::this_thread::sleep_until(wake_up);
      status_.timing.wake_up.add(nanoseconds(steady_clock::now() - wake_up));
    }
  }
}

/// Time from one wake-up to the next: the time until the next output, rounded to whole periods.
steady_clock::duration TwinLoop::pause(Stamp next_awaited) const noexcept
{
  if (clock_kind_ == ClockKind::STEPPED || status_.state != LoopState::RUNNING)
  {
    return CYCLE_PERIOD;
  }
  const Stamp ahead = next_awaited + input_delay_ - status_.clock;
  return std::clamp<steady_clock::duration>(ahead / nanoseconds(CYCLE_PERIOD) * CYCLE_PERIOD, shortest_pause_,
                                            MAX_PAUSE);
}

void TwinLoop::cycle(steady_clock::time_point begin) noexcept
{
  // Before the first time of the clock the twin has not started, and inputs cannot be ordered.
  if (clock_() == 0)
  {
    resets_done_ = resets_requested_.load();
    return;
  }
  // If a callback holds the inbox, this cycle only advances the twin, and the next cycle handles the inputs.
  if (!inbox_.use([this](Inputs& inputs) { heed(inputs); }))
  {
    const Stamp now = clock_();
    status_.clock = isJump(now) ? status_.clock : std::max(status_.clock, now);
  }
  if (status_.state == LoopState::RUNNING)
  {
    catchUp(begin);
  }
  status_.twin_stamp = twin_.stamp();
  twin_.show(status_);
}

/// Handles the inputs. The clock is read after the inputs have arrived, so that no input that arrived after a jump of
/// the clock counts as one from before the jump.
void TwinLoop::heed(Inputs& inputs) noexcept
{
  if (readClock(clock_()))
  {
    forgetInputs(inputs);
  }
  stampInputs(inputs);
  answerRequests(inputs);
  if (status_.state == LoopState::RUNNING || tryStart(inputs))
  {
    handOver(inputs);
  }
  else
  {
    thinOut(inputs);
  }
  waiting_ = inputs.size();
}

/// Whether the clock has jumped. The first reading of the clock is not a jump.
bool TwinLoop::isJump(Stamp now) const noexcept
{
  const Stamp step = now - status_.clock;
  return status_.clock != 0 && (step < -CLOCK_JUMP_TOLERANCE || step > MAX_CLOCK_STEP);
}

/// Updates the status with a new reading of the clock. @returns whether the clock has jumped.
bool TwinLoop::readClock(Stamp now) noexcept
{
  const bool jumped = isJump(now);
  if (jumped)
  {
    ++status_.clock_jumps;
    status_.last_jump = now - status_.clock;
    status_.state = LoopState::WAITING_FOR_CLOCK;
    status_.clock = now;
    status_.lag = 0;
  }
  status_.clock = std::max(status_.clock, now);
  return jumped;
}

void TwinLoop::answerRequests(Inputs& inputs) noexcept
{
  const std::uint64_t requested = resets_requested_;
  if (requested != resets_done_)
  {
    forgetInputs(inputs);
    start(limit(), inputs);
    ++status_.resets;
    resets_done_ = requested;
  }
}

/// Removes the inputs that arrived before this cycle.
void TwinLoop::forgetInputs(Inputs& inputs) noexcept
{
  inputs.erase(inputs.begin(), inputs.begin() + static_cast<std::ptrdiff_t>(waiting_));
  waiting_ = 0;
}

/// Checks the stamps of the inputs that arrived in this cycle. A stamp of 0 was set before the clock had a time, and
/// becomes the present time. An input with a stamp far from the clock is refused.
void TwinLoop::stampInputs(Inputs& inputs) noexcept
{
  const auto fresh = inputs.begin() + static_cast<std::ptrdiff_t>(waiting_);
  for (auto input = fresh; input != inputs.end(); ++input)
  {
    Stamp& stamp = stampOf(input->input);
    stamp = stamp == 0 ? status_.clock : stamp;
  }
  const auto kept_end =
      std::remove_if(fresh, inputs.end(),
                     [this](const LiveInput& input) { return std::abs(input.stamp() - status_.clock) > FAR_STAMP; });
  status_.far_stamps += static_cast<std::uint64_t>(inputs.end() - kept_end);
  inputs.erase(kept_end, inputs.end());
}

/// Keeps only the last due input of each kind while the twin waits for its start. If repeated inputs filled the inbox,
/// the inbox could not accept the torque that starts the twin.
void TwinLoop::thinOut(Inputs& inputs) noexcept
{
  const Stamp due = limit();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i)
  {
    const LiveInput input = inputs[i];
    const bool overtaken = input.stamp() <= due && input.value() != nullptr &&
                           std::any_of(inputs.begin() + static_cast<std::ptrdiff_t>(i) + 1, inputs.end(),
                                       [&](const LiveInput& later)
                                       {
                                         return later.isOf(input.value()->kind) && later.joint == input.joint &&
                                                later.stamp() >= input.stamp() && later.stamp() <= due;
                                       });
    inputs[kept] = input;
    kept += overtaken ? 0 : 1;
  }
  inputs.erase(inputs.begin() + static_cast<std::ptrdiff_t>(kept), inputs.end());
}

bool TwinLoop::tryStart(Inputs& inputs) noexcept
{
  if (!wait_for_first_input_)
  {
    start(status_.clock, inputs);
    return true;
  }
  // Several topics may bring the first inputs in any order. The twin starts at the earliest stamp, after the clock has
  // passed this stamp.
  status_.state = LoopState::WAITING_FOR_INPUT;
  Stamp first = std::numeric_limits<Stamp>::max();
  for (const LiveInput& input : inputs)
  {
    if (input.isOf(InputKind::MOTOR_TORQUE) || input.isOf(InputKind::LOAD_TORQUE))
    {
      first = std::min(first, input.stamp());
    }
  }
  if (first > limit())
  {
    return false;
  }
  start(first, inputs);
  return true;
}

void TwinLoop::start(Stamp stamp, Inputs& inputs) noexcept
{
  twin_.reset(stamp);
  status_.state = LoopState::RUNNING;
  status_.lag = 0;
  status_.largest_lag = 0;
  status_.command_seen = false;
  status_.timing = {};
  released_ = status_.clock;
  start_stamp_ = stamp;
  start_time_ = steady_clock::now();
  // Inputs that were due before the start of the twin act from the twin's first instant on, and do not count as late.
  for (LiveInput& input : inputs)
  {
    stampOf(input.input) = std::max(input.stamp(), stamp);
  }
}

void TwinLoop::handOver(Inputs& inputs) noexcept
{
  for (const LiveInput& input : inputs)
  {
    twin_.push(input);
    if (input.isOf(InputKind::MOTOR_TORQUE))
    {
      status_.last_command = status_.command_seen ? std::max(status_.last_command, input.stamp()) : input.stamp();
      status_.command_seen = true;
    }
  }
  inputs.clear();
}

void TwinLoop::catchUp(steady_clock::time_point begin) noexcept
{
  if (clock_kind_ == ClockKind::STEPPED && status_.lag < step_length_)
  {
    released_ = status_.clock;
  }
  const Stamp first = twin_.stamp() + step_length_;
  const Stamp until = std::min(limit(), twin_.stamp() + MAX_CATCH_UP);
  while (steady_clock::now() - begin < LONGEST_WORK && twin_.step(until))
  {
    after_step_();
  }
  status_.lag = std::max<Stamp>(limit() - twin_.stamp(), 0);
  status_.largest_lag = std::max(status_.largest_lag, status_.lag);
  if (twin_.stamp() >= first)
  {
    judgeLateness(std::max(first + input_delay_, released_));
  }
}

void TwinLoop::judgeLateness(Stamp due) noexcept
{
  const Stamp lateness = clock_() - due;
  status_.timing.lateness.add(lateness);
  if (lateness > deadline_)
  {
    ++status_.timing.missed_deadlines;
  }
}

void TwinLoop::keepTimes(steady_clock::time_point begin, steady_clock::time_point end) noexcept
{
  ++status_.cycles;
  if (end - begin > CYCLE_PERIOD)
  {
    ++status_.overruns;
  }
  if (status_.state == LoopState::RUNNING)
  {
    LoopTiming& timing = status_.timing;
    timing.longest_cycle = std::max(timing.longest_cycle, nanoseconds(end - begin));
    timing.busy += nanoseconds(end - begin);
    timing.elapsed = nanoseconds(end - start_time_);
    timing.simulated = twin_.stamp() - start_stamp_;
  }
}
}  // namespace hjt
