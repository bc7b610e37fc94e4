// SPDX-License-Identifier: BSD-3-Clause
#include "apps/sweep/sweep.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>

#include "apps/common/interrupt.hpp"
#include "apps/common/progress.hpp"
#include "apps/common/run_summary.hpp"
#include "apps/sweep/run_file.hpp"

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "ros_io/time.hpp"

namespace hjt
{
namespace
{
using Json = OrderedJson;

/// The run through to its end, into its file.
class RunSimulation
{
public:
  RunSimulation(const Plan& plan, const SweepDirectory& directory, const SurfaceSource& surface_source,
                std::atomic<std::uint64_t>& simulated)
    : plan_(plan), directory_(directory), surface_source_(surface_source), simulated_(simulated)
  {
  }

  /// False: interrupted, and no file left. @throws InputError if the file cannot be written.
  bool simulate(std::uint64_t number)
  {
    const RunSpec spec = plan_.run(number);
    Json record = recordOf(spec, directory_.runFileName(number));
    const std::string path = directory_.runFile(number);
    std::optional<Twin> twin;
    try
    {
      twin.emplace(spec.parameters, surface_source_);
    }
    catch (const ParameterError& error)
    {
      record["status"] = "failed";
      record["error"] = error.what();
      makeRunFile(plan_.recording(), spec, nullptr, path)->finish(record);
      return true;
    }
    twin->watchSignals(plan_.recording().format == RunFormat::BAG);  // a bag holds the indicators, from the start on
    twin->reset(SIMULATION_EPOCH);
    const auto file = makeRunFile(plan_.recording(), spec, &*twin, path);
    if (!march(*twin, spec, *file))
    {
      return false;
    }
    const TwinCounters& counters = twin->counters();
    if (counters.solver_failures > 0)
    {
      record["status"] = "failed";
      record["error"] = "the solver found no equilibrium at " +
                        numberText(toSeconds(twin->stamp() - SIMULATION_EPOCH)) + " s; the record ends there";
    }
    record["steps"] = counters.steps;
    record["steps_on_surface"] = on_surface_;
    record["coarse_steps"] = counters.coarse_steps;
    record["torque_clamped"] = counters.torque_clamped;
    record["jumps"] = counters.jumps;
    file->finish(record);
    return true;
  }

private:
  bool march(Twin& twin, const RunSpec& spec, RunFile& file)
  {
    constexpr std::uint64_t STEPS_PER_LOOK = 1024;
    const Recording& recording = plan_.recording();
    const Stamp end = SIMULATION_EPOCH + toStampLength(spec.duration);
    const double step = toSeconds(twin.stepLength());
    DutyFeeder feeder(spec.duty, twin);
    on_surface_ = 0;
    for (std::uint64_t steps = 1;; ++steps)
    {
      const double time = static_cast<double>(steps) * step;
      feeder.feed(twin, time);
      if (recording.indicators && time > recording.start)
      {
        twin.watchSignals(true);  // a window that held the start would stand apart from all others
      }
      if (!twin.step(end))
      {
        return true;
      }
      on_surface_ += twin.onSurface() ? 1 : 0;
      if (twin.counters().solver_failures > 0)
      {
        return true;
      }
      file.record(twin, feeder);
      if (steps % STEPS_PER_LOOK == 0)
      {
        simulated_ += STEPS_PER_LOOK;
        if (interruptSignal() != 0)
        {
          return false;
        }
      }
    }
  }

  const Plan& plan_;
  const SweepDirectory& directory_;
  const SurfaceSource& surface_source_;
  std::atomic<std::uint64_t>& simulated_;
  std::uint64_t on_surface_{};
};

/// The runs still to be done, taken one by one by as many threads as wanted.
class Workers
{
public:
  Workers(const Plan& plan, const SweepDirectory& directory, const SurfaceSource& source,
          std::vector<std::uint64_t> todo)
    : plan_(plan), directory_(directory), source_(source), todo_(std::move(todo))
  {
  }

  void work(unsigned jobs, bool quiet)
  {
    double steps = 0.0;
    for (const std::uint64_t number : todo_)
    {
      const RunSpec spec = plan_.run(number);
      steps += spec.duration * spec.parameters.solver.rate;
    }
    running_ = jobs;
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < jobs; ++i)
    {
      threads.emplace_back([this] { workOne(); });
    }
    for (Progress progress("sweep"); running_ > 0;)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
      if (!quiet && simulated_ > 0)
      {
        progress.update(static_cast<double>(simulated_) / steps);
      }
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
    if (error_)
    {
      std::rethrow_exception(error_);
    }
  }

  std::uint64_t done() const { return done_; }

private:
  void workOne()
  {
    try
    {
      RunSimulation simulation(plan_, directory_, source_, simulated_);
      while (interruptSignal() == 0 && !stop_)
      {
        const std::size_t next = next_++;
        if (next >= todo_.size() || !simulation.simulate(todo_[next]))
        {
          break;
        }
        ++done_;
      }
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      error_ = error_ ? error_ : std::current_exception();
      stop_ = true;
    }
    --running_;
  }

  const Plan& plan_;
  const SweepDirectory& directory_;
  const SurfaceSource& source_;
  const std::vector<std::uint64_t> todo_;
  std::atomic<std::uint64_t> simulated_{};  // steps, about
  std::atomic<std::size_t> next_{};
  std::atomic<std::uint64_t> done_{};
  std::atomic<unsigned> running_{};
  std::atomic<bool> stop_{};
  std::mutex mutex_;
  std::exception_ptr error_;
};
}  // namespace

void checkRuns(const Plan& plan)
{
  for (std::uint64_t run = 0; run < plan.runs(); ++run)
  {
    try
    {
      plan.run(run);
    }
    catch (const InputError& error)
    {
      throw InputError(std::string(error.what()) + " (run " + std::to_string(run) + " of " +
                       std::to_string(plan.runs()) + "; nothing has been run)");
    }
  }
}

RunCost measureCost(const RunSpec& spec, const SurfaceSource& surface_source)
{
  constexpr double SAMPLE = 0.2;  // [s]
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point begin)
  { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  RunCost cost;
  const Clock::time_point first_begin = Clock::now();
  Twin first(spec.parameters, surface_source);  // may have to build its surface, once for all runs
  cost.surface = since(first_begin);
  const Clock::time_point begin = Clock::now();
  Twin twin(spec.parameters, surface_source);
  cost.start = since(begin);
  twin.reset(SIMULATION_EPOCH);
  DutyFeeder feeder(spec.duty, twin);
  const Clock::time_point marched = Clock::now();
  const Stamp end = SIMULATION_EPOCH + toStampLength(std::min(SAMPLE, spec.duration));
  do
  {
    feeder.feed(twin, toSeconds(twin.stamp() + twin.stepLength() - SIMULATION_EPOCH));
  } while (twin.step(end));
  cost.real_time_factor = toSeconds(twin.stamp() - SIMULATION_EPOCH) / since(marched);
  return cost;
}

SweepResult runSweep(const Plan& plan, SweepDirectory& directory, const SweepOptions& options,
                     const SurfaceSource& surface_source)
{
  SweepResult result;
  std::vector<std::uint64_t> todo;
  for (std::uint64_t run = options.shard; run < plan.runs(); run += options.shards)
  {
    if (directory.isFinished(run))
    {
      ++result.present;
    }
    else
    {
      result.damaged += std::filesystem::exists(directory.runFile(run)) ? 1 : 0;
      directory.lock(run);  // all before any work: of two sweeps one goes on to its end
      todo.push_back(run);
    }
  }
  if (!todo.empty())
  {
    Workers workers(plan, directory, surface_source, todo);
    workers.work(static_cast<unsigned>(std::min<std::size_t>(options.jobs, todo.size())), options.quiet);
    result.done = workers.done();
  }
  directory.writeIndex();
  for (std::uint64_t run = options.shard; run < plan.runs(); run += options.shards)
  {
    const Json record = directory.record(run);
    result.failed += record.is_object() && record.at("status") != "ok" ? 1 : 0;
  }
  return result;
}
}  // namespace hjt
