// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>

#include "datasets/run_file.hpp"
#include "datasets/sweep_directory.hpp"

#include "surface/surface_cache.hpp"

namespace hjt
{
/// Cost of a run.
struct RunCost
{
  double surfaces{};          ///< time to build its response surfaces or to find them in the cache [s]
  double ends{};              ///< before the first step, the surfaces at hand, and after the last one [s]
  double real_time_factor{};  ///< simulated over real time, one core [-]
};

/// How far runs are that are simulated by several threads.
struct RunCourse
{
  std::atomic<std::uint64_t> simulated{};  ///< about, RunSimulation::WHOLE a run
  std::atomic<bool> stop{};                ///< set by others: no run goes on
};

/// Simulates runs of a plan, one after the other.
class RunSimulation
{
public:
  static constexpr std::uint64_t WHOLE = 1'000'000;  ///< added to RunCourse::simulated over a run

  RunSimulation(const Plan& plan, const SweepDirectory& directory, const SurfaceSource& surface_source,
                RunCourse& course)
    : plan_(plan), directory_(directory), surface_source_(surface_source), course_(course)
  {
  }

  /// A run through to its end, into its file. False: stopped, and no file left.
  /// @throws InputError if the file cannot be written.
  bool simulate(std::uint64_t number);

  /// Tries a run, for no longer than `seconds` by the clock, and leaves nothing of it.
  /// @throws InputError, ParameterError if the run's drive has no equilibrium.
  RunCost sample(std::uint64_t number, double seconds);

private:
  using Clock = std::chrono::steady_clock;

  /// Object of a run: a drive in its duty cycle, or an arm along its set points.
  class Subject
  {
  public:
    virtual ~Subject() = default;
    virtual bool step(double time, Stamp end) = 0;  ///< to `time` since the start of the run [s]; false: it is over
    virtual void record(RunFile& file) = 0;
    virtual const Twin& drive() const = 0;  ///< the first
    virtual TwinCounters counters() const = 0;
    virtual bool onSurface() const = 0;
    virtual void tell(OrderedJson& record) const = 0;
  };
  class Drive;
  class Arm;

  /// At its start. @throws ParameterError if a drive has no equilibrium.
  std::unique_ptr<Subject> begin(const RunSpec& spec) const;
  bool march(Subject& subject, const RunSpec& spec, RunFile& file, Clock::time_point until);

  const Plan& plan_;
  const SweepDirectory& directory_;
  const SurfaceSource& surface_source_;
  RunCourse& course_;
  std::uint64_t on_surface_{};
};
}  // namespace hjt
