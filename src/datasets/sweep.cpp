// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/sweep.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "datasets/run_file.hpp"
#include "datasets/run_simulation.hpp"
#include "output/interrupt.hpp"
#include "output/progress.hpp"

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
using Json = OrderedJson;

/// The runs still to be done, taken one by one by as many threads as wanted.
class Workers
{
public:
  Workers(const Plan& plan, const SweepDirectory& directory, const SurfaceSource& source,
          std::vector<std::uint64_t> todo)
    : plan_(plan), directory_(directory), source_(source), todo_(std::move(todo))
  {
  }

  void work(unsigned jobs)
  {
    std::vector<std::thread> threads = start(jobs);
    for (Progress progress("sweep"); running_ > 0;)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
      if (simulated_ > 0)
      {
        progress.update(static_cast<double>(simulated_) / static_cast<double>(RunSimulation::WHOLE * todo_.size()));
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
  /// As many threads as there are to be had. @throws InputError if there are none.
  std::vector<std::thread> start(unsigned jobs)
  {
    std::vector<std::thread> threads;
    threads.reserve(jobs);
    try
    {
      while (threads.size() < jobs)
      {
        ++running_;
        threads.emplace_back([this] { workOne(); });
      }
    }
    catch (const std::system_error& error)
    {
      --running_;
      const std::string found = std::to_string(threads.size()) + " of " + std::to_string(jobs) +
                                " threads (--jobs) could be started: " + error.what();
      if (threads.empty())
      {
        throw InputError(found);
      }
      std::cerr << "warning: " << found << "; they do all the runs\n";
    }
    return threads;
  }

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
  std::atomic<std::uint64_t> simulated_{};  // about, RunSimulation::WHOLE a run
  std::atomic<std::size_t> next_{};
  std::atomic<std::uint64_t> done_{};
  std::atomic<unsigned> running_{};
  std::atomic<bool> stop_{};
  std::mutex mutex_;
  std::exception_ptr error_;
};
}  // namespace

RunSpec checkedRun(const Plan& plan, std::uint64_t run)
{
  try
  {
    return plan.run(run);
  }
  catch (const InputError& error)
  {
    throw InputError(std::string(error.what()) + " (run " + std::to_string(run) + " of " + std::to_string(plan.runs()) +
                     "; nothing has been run)");
  }
}

void checkRuns(const Plan& plan)
{
  for (std::uint64_t run = 0; run < plan.runs(); ++run)
  {
    checkedRun(plan, run);
  }
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
      todo.push_back(run);
    }
  }
  directory.claim(todo);  // all before any work: of two sweeps one goes on to its end
  if (!todo.empty())
  {
    Workers workers(plan, directory, surface_source, todo);
    workers.work(static_cast<unsigned>(std::min<std::size_t>(options.jobs, todo.size())));
    result.done = workers.done();
  }
  directory.writeIndex();
  for (std::uint64_t run = options.shard; run < plan.runs(); run += options.shards)
  {
    const Json record = directory.record(run);
    if (record.is_object())
    {
      result.failed += record.at("status") != "ok" ? 1 : 0;
      result.rows_without_forces += record.value(ROWS_WITHOUT_FORCES, std::uint64_t{});
    }
  }
  return result;
}
}  // namespace hjt
