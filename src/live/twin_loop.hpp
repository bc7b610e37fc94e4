// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "harmonic_joint_twin/twin/input_queue.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "live/thread_exchange.hpp"

namespace hjt
{
/// Histogram of latencies from a microsecond to 17 s, with eight bins in each octave. The size is fixed, so that adding
/// a value does not allocate and takes a constant time.
class LatencyHistogram
{
public:
  static constexpr int BIN_BITS = 3;  ///< number of bits after the leading bit that select the bin within an octave
  static constexpr int BINS_PER_OCTAVE = 1 << BIN_BITS;
  static constexpr int FIRST_OCTAVE = 10;  ///< all values below 2^10 ns are in the first bin
  static constexpr int END_OCTAVE = 34;    ///< all values beyond 2^34 ns are in the last bin
  static constexpr std::size_t BIN_COUNT = 1 + BINS_PER_OCTAVE * (END_OCTAVE - FIRST_OCTAVE);

  /// Counts a latency. @param latency [ns]; a negative latency counts as zero.
  void add(Stamp latency) noexcept
  {
    ++bins_[binOf(latency)];
    ++count_;
    largest_ = std::max(largest_, latency);
  }

  std::uint64_t count() const noexcept { return count_; }
  Stamp largest() const noexcept { return largest_; }  ///< largest latency [ns]

  /// Quantile `share` (0 ... 1) of the counted latencies [ns], rounded up to the upper edge of a bin; 0 without
  /// latencies.
  Stamp quantile(double share) const noexcept
  {
    std::uint64_t counted = 0;
    for (std::size_t bin = 0; bin < BIN_COUNT; ++bin)
    {
      counted += bins_[bin];
      if (counted > 0 && static_cast<double>(counted) >= share * static_cast<double>(count_))
      {
        return std::min(binEnd(bin), largest_);
      }
    }
    return 0;
  }

  const std::array<std::uint64_t, BIN_COUNT>& bins() const noexcept { return bins_; }

  /// Upper edge of a bin [ns].
  static Stamp binEnd(std::size_t bin) noexcept
  {
    const auto octave = static_cast<int>(FIRST_OCTAVE * BINS_PER_OCTAVE + bin) / BINS_PER_OCTAVE;
    const auto within = static_cast<Stamp>(bin % BINS_PER_OCTAVE);
    return (BINS_PER_OCTAVE + within) << (octave - BIN_BITS);
  }

private:
  static std::size_t binOf(Stamp latency) noexcept
  {
    const int octave = latency > 0 ? std::ilogb(static_cast<double>(latency)) : 0;
    if (octave < FIRST_OCTAVE)
    {
      return 0;
    }
    const Stamp within = (latency >> (octave - BIN_BITS)) - BINS_PER_OCTAVE;
    const Stamp bin = 1 + (octave - FIRST_OCTAVE) * BINS_PER_OCTAVE + within;
    return std::min(static_cast<std::size_t>(bin), BIN_COUNT - 1);
  }

  std::array<std::uint64_t, BIN_COUNT> bins_{};
  std::uint64_t count_{};
  Stamp largest_{};
};

/// A small value that the loop shows to other threads. The loop never waits: it omits a write while a thread reads.
template <class Value>
class TryLockValue
{
public:
  void tryWrite(const Value& value) noexcept
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (lock.owns_lock())
    {
      value_ = value;
    }
  }

  Value read() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return value_;
  }

private:
  mutable std::mutex mutex_;
  Value value_{};
};

enum class LoopState : std::uint8_t
{
  WAITING_FOR_CLOCK,  ///< the clock has no time yet
  WAITING_FOR_INPUT,  ///< with input.wait_for_first_input: the twin is at rest until a torque arrives
  RUNNING
};

/// Timing of the loop since the last start or reset.
struct LoopTiming
{
  LatencyHistogram wake_up;          ///< wall clock time from the requested wake-up to the beginning of a cycle [ns]
  LatencyHistogram lateness;         ///< delay of the oldest instant of a cycle after the time when it was due [ns]
  std::uint64_t missed_deadlines{};  ///< number of cycles whose lateness exceeded realtime.deadline
  Stamp longest_cycle{};             ///< longest cycle in wall clock time [ns]
  Stamp busy{};                      ///< sum of the lengths of all cycles in wall clock time [ns]
  Stamp elapsed{};                   ///< wall clock time since the start or reset [ns]
  Stamp simulated{};                 ///< simulated time since the start or reset [ns]

  /// Simulated time over wall clock time; 0 at the start [-].
  double realTimeFactor() const noexcept { return shareOfElapsed(simulated); }
  /// Share of the wall clock time in which the loop worked [-].
  double load() const noexcept { return shareOfElapsed(busy); }

private:
  double shareOfElapsed(Stamp length) const noexcept
  {
    return elapsed > 0 ? static_cast<double>(length) / static_cast<double>(elapsed) : 0.0;
  }
};

enum class ClockKind : std::uint8_t
{
  RUNNING,  ///< the system's clock: an instant is due when the clock shows its time
  STEPPED   ///< /clock: all instants up to a time on /clock are due when the loop has read this time
};

/// Status that the loop publishes once in a cycle.
struct LoopStatus
{
  LoopState state{};
  Stamp clock{};        ///< last reading of the clock [ns]
  Stamp twin_stamp{};   ///< instant that the twin has reached [ns]
  Stamp lag{};          ///< instant that the twin should have reached - reached instant [ns]
  Stamp largest_lag{};  ///< largest lag since the last start or reset [ns]
  std::uint64_t cycles{};
  std::uint64_t overruns{};     ///< number of cycles that took longer than their period
  std::uint64_t clock_jumps{};  ///< number of jumps of the clock, forwards and back
  Stamp last_jump{};            ///< size of the clock's last jump; > 0 forwards [ns]
  std::uint64_t resets{};       ///< number of resets that a user requested
  std::uint64_t far_stamps{};   ///< number of inputs refused because their stamps differ from the clock by > FAR_STAMP
  bool command_seen{};          ///< whether a motor torque command has arrived since the last start or reset
  Stamp last_command{};         ///< latest stamp of a motor torque command [ns]
  JointOutputs outputs;
  TwinCounters counters;
  Assessment assessment;
  LoopTiming timing;
};

/// Interface by which a loop advances one twin, or several twins with common steps. No member may block or allocate.
class Advanced
{
public:
  virtual ~Advanced() = default;

  virtual bool reset(Stamp stamp) noexcept = 0;            ///< as Twin::reset
  virtual void push(const LiveInput& input) noexcept = 0;  ///< as Twin::push
  virtual bool step(Stamp until) noexcept = 0;             ///< as Twin::step
  virtual Stamp stamp() const noexcept = 0;                ///< as Twin::stamp
  /// Sets those members of the status that the loop does not know. The loop calls this function once in a cycle.
  virtual void show(LoopStatus& status) noexcept = 0;

protected:
  Advanced() = default;
  Advanced(const Advanced&) = default;
  Advanced& operator=(const Advanced&) = default;
};

/// Adapter that lets a loop advance one twin.
class AdvancedTwin : public Advanced
{
public:
  explicit AdvancedTwin(Twin& twin) : twin_(twin) {}

  bool reset(Stamp stamp) noexcept override { return twin_.reset(stamp); }
  void push(const LiveInput& input) noexcept override { twin_.push(input.input); }
  bool step(Stamp until) noexcept override { return twin_.step(until); }
  Stamp stamp() const noexcept override { return twin_.stamp(); }
  void show(LoopStatus& status) noexcept override
  {
    status.outputs = twin_.outputs();
    status.counters = twin_.counters();
    status.assessment = twin_.assessment();
  }

private:
  Twin& twin_;
};

/// Advances the twin to the clock in a separate thread, without allocation, logging, or locks that are held for long.
///
/// The twin stays `input.delay` behind the clock and never skips time. After a forward step of the clock of up to
/// MAX_CLOCK_STEP the twin catches up. Each cycle simulates a limited time, so that the loop still handles inputs and
/// requests. If the clock jumps back, or further forwards, the twin restarts.
///
/// With a continuous clock the loop sleeps until the next output is due, at least a fifth of `input.delay` (one
/// millisecond to SHORT_PAUSE) and at most MAX_PAUSE. The results do not depend on the sleep, because inputs act by
/// their stamps.
class TwinLoop
{
public:
  using Clock = std::function<Stamp()>;     ///< returns the present time [ns]; 0 if the clock has no time yet
  using AfterStep = std::function<void()>;  ///< called at every simulated instant; must not block or allocate
  /// Called after each cycle with the instant that the cycle reached. Returns the instant of the next output [ns]. Must
  /// not block or allocate.
  using AfterCycle = std::function<Stamp(Stamp)>;

  /// Largest difference of successive readings of the clock that is not a jump [ns]. Jumps come, for example, from the
  /// start of another recording or from a suspended machine.
  static constexpr Stamp MAX_CLOCK_STEP = 10'000'000'000;

  /// Starts the thread. Without `after_cycle` every instant has an output. `parameters`: those of the twin, or of any
  /// of several twins.
  TwinLoop(Advanced& twin, const Parameters& parameters, Inbox& inbox, Clock clock, ClockKind clock_kind,
           AfterStep after_step, AfterCycle after_cycle = {});

  ~TwinLoop();

  /// Restarts the twin at the current instant and waits for the restart. Thread-safe. @returns false if the loop did
  /// not answer.
  bool reset();

  LoopStatus status() const { return shown_status_.read(); }

  /// Handle of the loop's thread, by which applyRealtime sets the thread's priority and processor.
  std::thread::native_handle_type thread() { return thread_.native_handle(); }

private:
  using Inputs = std::vector<LiveInput>;

  void run();
  std::chrono::steady_clock::duration pause(Stamp next_awaited) const noexcept;
  void cycle(std::chrono::steady_clock::time_point begin) noexcept;
  bool isJump(Stamp now) const noexcept;
  bool readClock(Stamp now) noexcept;
  void heed(Inputs& inputs) noexcept;
  void answerRequests(Inputs& inputs) noexcept;
  void forgetInputs(Inputs& inputs) noexcept;
  void stampInputs(Inputs& inputs) noexcept;
  void thinOut(Inputs& inputs) noexcept;
  bool tryStart(Inputs& inputs) noexcept;
  void start(Stamp stamp, Inputs& inputs) noexcept;
  void handOver(Inputs& inputs) noexcept;
  Stamp limit() const noexcept { return std::max<Stamp>(status_.clock - input_delay_, 0); }
  void catchUp(std::chrono::steady_clock::time_point begin) noexcept;
  void judgeLateness(Stamp due) noexcept;
  void keepTimes(std::chrono::steady_clock::time_point begin, std::chrono::steady_clock::time_point end) noexcept;

  Advanced& twin_;
  Inbox& inbox_;
  Clock clock_;
  const ClockKind clock_kind_;
  AfterStep after_step_;
  AfterCycle after_cycle_;
  const Stamp input_delay_;
  const std::chrono::steady_clock::duration shortest_pause_;
  const Stamp deadline_;     ///< realtime.deadline, the largest lateness of an instant [ns]
  const Stamp step_length_;  ///< length of a step of the twin [ns]
  const bool wait_for_first_input_;
  std::size_t waiting_{};  ///< number of inputs of earlier cycles that wait for the start of the twin
  Stamp released_{};       ///< earliest time of the clock at which the instants of the present cycle were due [ns]
  Stamp start_stamp_{};    ///< first instant since the last start or reset [ns]
  std::chrono::steady_clock::time_point start_time_;
  LoopStatus status_;
  TryLockValue<LoopStatus> shown_status_;
  std::atomic<std::uint64_t> resets_requested_{ 0 };
  std::atomic<std::uint64_t> resets_done_{ 0 };
  std::atomic<bool> stopping_{ false };
  std::thread thread_;
};
}  // namespace hjt
