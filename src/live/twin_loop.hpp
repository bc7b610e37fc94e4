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
/// Counts latencies in bins of fixed relative width, eight to a doubling, from a microsecond to 17 s. Fixed size:
/// adding allocates nothing and costs the same whatever comes.
class LatencyHistogram
{
public:
  static constexpr int BIN_BITS = 3;  ///< of a latency, below its leading one, that choose the bin within the octave
  static constexpr int BINS_PER_OCTAVE = 1 << BIN_BITS;
  static constexpr int FIRST_OCTAVE = 10;  ///< below 2^10 ns everything falls into the first bin
  static constexpr int END_OCTAVE = 34;    ///< beyond 2^34 ns everything falls into the last
  static constexpr std::size_t BIN_COUNT = 1 + BINS_PER_OCTAVE * (END_OCTAVE - FIRST_OCTAVE);

  /// @param latency [ns]; less than zero counts as zero.
  void add(Stamp latency) noexcept
  {
    ++bins_[binOf(latency)];
    ++count_;
    largest_ = std::max(largest_, latency);
  }

  std::uint64_t count() const noexcept { return count_; }
  Stamp largest() const noexcept { return largest_; }  ///< [ns]

  /// Latency [ns] that `share` (0 ... 1) of those counted do not exceed, rounded up to the end of its bin; 0 if there
  /// are none.
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

  /// Upper end of a bin [ns].
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

/// A small value the loop shows to other threads. The writer never waits: it skips a write while somebody reads.
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
  WAITING_FOR_CLOCK,  ///< no time has been seen yet
  WAITING_FOR_INPUT,  ///< input.wait_for_first_input: at rest until a torque arrives
  RUNNING
};

/// How the loop keeps up, since the last start or reset.
struct LoopTiming
{
  LatencyHistogram wake_up;          ///< how late a cycle began after the loop had asked to be woken, by the wall clock
  LatencyHistogram lateness;         ///< how late the oldest instant of a cycle was simulated after it was due
  std::uint64_t missed_deadlines{};  ///< cycles in which that was more than realtime.deadline
  Stamp longest_cycle{};             ///< by the wall clock [ns]
  Stamp busy{};                      ///< sum of all cycles, by the wall clock [ns]
  Stamp elapsed{};                   ///< by the wall clock [ns]
  Stamp simulated{};                 ///< [ns]

  /// Simulated over wall time; 0 at the start [-].
  double realTimeFactor() const noexcept { return shareOfElapsed(simulated); }
  /// Share of the wall time in which the loop worked [-].
  double load() const noexcept { return shareOfElapsed(busy); }

private:
  double shareOfElapsed(Stamp length) const noexcept
  {
    return elapsed > 0 ? static_cast<double>(length) / static_cast<double>(elapsed) : 0.0;
  }
};

/// Kind of the clock that the loop follows.
enum class ClockKind : std::uint8_t
{
  RUNNING,  ///< runs on by itself: every instant is due at a time of its own
  STEPPED   ///< driven by /clock: all instants of a step are due once the step has been read
};

/// What the loop shows of itself once per cycle.
struct LoopStatus
{
  LoopState state{};
  Stamp clock{};        ///< time read last [ns]
  Stamp twin_stamp{};   ///< simulated instant [ns]
  Stamp lag{};          ///< how far the twin is behind the instant it should have reached [ns]
  Stamp largest_lag{};  ///< since the last start or reset [ns]
  std::uint64_t cycles{};
  std::uint64_t overruns{};     ///< cycles whose work took longer than their period
  std::uint64_t clock_jumps{};  ///< times the clock jumped, back or ahead
  Stamp last_jump{};            ///< by how much then; > 0 ahead [ns]
  std::uint64_t resets{};       ///< resets on request
  std::uint64_t far_stamps{};   ///< inputs refused: stamped further than FAR_STAMP from the clock
  bool command_seen{};          ///< a motor torque command has come since the last start or reset
  Stamp last_command{};         ///< latest stamp of one [ns]
  JointOutputs outputs;
  TwinCounters counters;
  Assessment assessment;
  LoopTiming timing;
};

/// What a loop advances: a twin, or several that step together. Nothing may wait or allocate.
class Advanced
{
public:
  virtual ~Advanced() = default;

  virtual bool reset(Stamp stamp) noexcept = 0;            ///< as Twin::reset
  virtual void push(const LiveInput& input) noexcept = 0;  ///< as Twin::push
  virtual bool step(Stamp until) noexcept = 0;             ///< as Twin::step
  virtual Stamp stamp() const noexcept = 0;                ///< as Twin::stamp
  virtual void show(LoopStatus& status) noexcept = 0;      ///< once a cycle: fills in what the status has of one twin

protected:
  Advanced() = default;
  Advanced(const Advanced&) = default;
  Advanced& operator=(const Advanced&) = default;
};

/// One twin.
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

/// Advances the twin to the clock in a thread of its own: no allocation, no log, no lock that anybody holds for long.
///
/// The twin stays `input.delay` behind the clock. It never skips time: after a step ahead of up to MAX_CLOCK_STEP it
/// catches up, a bounded stretch per cycle so that inputs, requests and the stop are still heard. A clock that jumps
/// back, or further ahead, restarts it.
///
/// On a clock that runs, the loop sleeps until the next output is due, at least a fifth of `input.delay`
/// (one to SHORT_PAUSE), at most MAX_PAUSE. What it simulates then is what it would have simulated in between: inputs
/// act by their stamps.
class TwinLoop
{
public:
  using Clock = std::function<Stamp()>;     ///< now [ns]; 0 while there is no time yet
  using AfterStep = std::function<void()>;  ///< called at every simulated instant; must not wait or allocate
  /// Called after each cycle with the instant it has reached; returns the instant of the next output [ns].
  /// Must not wait or allocate.
  using AfterCycle = std::function<Stamp(Stamp)>;

  /// From one reading of the clock to the next; more is a jump, of another recording or a machine that slept [ns].
  static constexpr Stamp MAX_CLOCK_STEP = 10'000'000'000;

  /// Starts the thread. Without `after_cycle` every instant is an output. `parameters`: of the twin or one of several.
  TwinLoop(Advanced& twin, const Parameters& parameters, Inbox& inbox, Clock clock, ClockKind clock_kind,
           AfterStep after_step, AfterCycle after_cycle = {});

  /// Stops the thread.
  ~TwinLoop();

  /// From any thread: restarts the twin at the current instant. Waits for it. False: the loop did not answer.
  bool reset();

  LoopStatus status() const { return shown_status_.read(); }

  /// The loop's thread, for its priority and processor.
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
  const Stamp deadline_;     ///< for each instant, after it was due [ns]
  const Stamp step_length_;  ///< [ns]
  const bool wait_for_first_input_;
  std::size_t waiting_{};  ///< inputs of earlier cycles that wait for the start
  Stamp released_{};       ///< no instant simulated now was due before this time of the clock [ns]
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
