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
struct RunCost
{
  double surfaces{};  ///< time for building or loading the response surfaces of the run [s]
  double ends{};      ///< computing time before the first and after the last step, without that for surfaces [s]
  double real_time_factor{};  ///< simulated time over computing time, on one core [-]
};

/// Progress of runs that several threads simulate.
struct RunCourse
{
  std::atomic<std::uint64_t> simulated{};  ///< approximate progress; a whole run adds RunSimulation::WHOLE
  std::atomic<bool> stop{};                ///< set by another thread to stop all runs
};

/// Simulates runs of a plan one after the other.
class RunSimulation
{
public:
  static constexpr std::uint64_t WHOLE = 1'000'000;  ///< value that a whole run adds to RunCourse::simulated

  RunSimulation(const Plan& plan, const SweepDirectory& directory, const SurfaceSource& surface_source,
                RunCourse& course)
    : plan_(plan), directory_(directory), surface_source_(surface_source), course_(course)
  {
  }

  /// Simulates a run and writes its file. @returns false if the run was stopped; then it has no file.
  /// @throws InputError if the file cannot be written.
  bool simulate(std::uint64_t number);

  /// Simulates a run for at most `seconds` of computing time, and removes its file. @throws InputError, ParameterError
  /// if a drive of the run has no equilibrium.
  RunCost sample(std::uint64_t number, double seconds);

private:
  using Clock = std::chrono::steady_clock;

  /// What a run simulates: a drive with its duty cycle, or an arm that follows its set points.
  class Subject
  {
  public:
    virtual ~Subject() = default;
    /// Advances to `time` since the start of the run [s]. Returns false if the run has ended.
    virtual bool step(double time, Stamp end) = 0;
    virtual void record(RunFile& file) = 0;
    virtual const Twin& drive() const = 0;  ///< the only drive, or the first drive of an arm
    virtual TwinCounters counters() const = 0;
    virtual bool onSurface() const = 0;
    virtual void tell(OrderedJson& record) const = 0;
  };
  class Drive;
  class Arm;

  /// Makes drive or arm in its state at the start of the run. @throws ParameterError if a drive has no equilibrium.
  std::unique_ptr<Subject> begin(const RunSpec& spec) const;
  bool march(Subject& subject, const RunSpec& spec, RunFile& file, Clock::time_point until);

  const Plan& plan_;
  const SweepDirectory& directory_;
  const SurfaceSource& surface_source_;
  RunCourse& course_;
  std::uint64_t on_surface_{};
};
}  // namespace hjt
