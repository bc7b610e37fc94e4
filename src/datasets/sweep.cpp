// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/sweep.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "datasets/run_file.hpp"
#include "datasets/run_simulation.hpp"

#include "harmonic_joint_twin/base/errors.hpp"
#include "surface/surface_cache.hpp"

namespace hjt
{
namespace
{
/// The numbers I and N of a text "I/N" with 0 <= I < N; empty if the text has another form.
std::optional<std::pair<std::uint64_t, std::uint64_t>> shardOf(const std::string& text)
{
  std::pair<std::uint64_t, std::uint64_t> shard;
  char slash = 0;
  std::istringstream stream(text);
  const bool read = static_cast<bool>(stream >> shard.first >> slash >> shard.second);
  return read && stream.peek() == EOF && slash == '/' && shard.first < shard.second ? std::make_optional(shard) :
                                                                                      std::nullopt;
}

/// Passes notices and progress from the threads of a sweep to the caller's thread.
class Told
{
public:
  void notice(const std::string& text)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (known_.insert(text).second)
    {
      notices_.push_back(text);
    }
  }

  /// The notices since the last call of this function.
  std::vector<std::string> notices()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(notices_, {});
  }

  std::atomic<double> built{};  ///< completed share of a response surface, 0 to 1

private:
  std::mutex mutex_;
  std::set<std::string> known_;
  std::vector<std::string> notices_;
};

/// Threads, each of which takes the next remaining run when it has finished one.
class Workers
{
public:
  Workers(const Plan& plan, const SweepDirectory& directory, std::vector<std::uint64_t> todo, unsigned jobs)
    : plan_(plan)
    , directory_(directory)
    , source_(runSurfaces(plan, jobs))
    , todo_(std::move(todo))
    , jobs_(static_cast<unsigned>(std::min<std::size_t>(jobs, todo_.size())))
  {
    source_.progress = [this](double done) { told_.built = done; };
    source_.notice = [this](const std::string& text) { told_.notice(text); };
  }

  void work(const Watch& watch)
  {
    std::vector<std::thread> threads = start();
    const auto building = watch.progress("building response surfaces");
    const auto sweeping = watch.progress("sweep");
    for (double built = 0.0; running_ > 0;)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
      tell(watch);
      if (told_.built != built)
      {
        built = told_.built;
        building(built);
      }
      if (course_.simulated > 0)
      {
        sweeping(static_cast<double>(course_.simulated) / static_cast<double>(RunSimulation::WHOLE * todo_.size()));
      }
      course_.stop = course_.stop || watch.stopped();
    }
    for (std::thread& thread : threads)
    {
      thread.join();
    }
    tell(watch);
    if (error_)
    {
      std::rethrow_exception(error_);
    }
  }

  std::uint64_t done() const { return done_; }

private:
  void tell(const Watch& watch)
  {
    for (const std::string& text : told_.notices())
    {
      watch.notice(text);
    }
  }

  /// Starts the threads, or as many of them as the system allows. @throws InputError if the system allows none.
  std::vector<std::thread> start()
  {
    std::vector<std::thread> threads;
    threads.reserve(jobs_);
    try
    {
      while (threads.size() < jobs_)
      {
        ++running_;
        threads.emplace_back([this] { workOne(); });
      }
    }
    catch (const std::system_error& error)
    {
      --running_;
      const std::string found = std::to_string(threads.size()) + " of " + std::to_string(jobs_) +
                                " threads (--jobs) could be started: " + error.what();
      if (threads.empty())
      {
        throw InputError(found);
      }
      told_.notice(found + "; these threads simulate all runs");
    }
    return threads;
  }

  void workOne()
  {
    try
    {
      RunSimulation simulation(plan_, directory_, source_, course_);
      while (!course_.stop)
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
      course_.stop = true;
    }
    --running_;
  }

  const Plan& plan_;
  const SweepDirectory& directory_;
  SurfaceSource source_;
  const std::vector<std::uint64_t> todo_;
  const unsigned jobs_;
  Told told_;
  RunCourse course_;  // progress of all runs that the threads simulate
  std::atomic<std::size_t> next_{};
  std::atomic<std::uint64_t> done_{};
  std::atomic<unsigned> running_{};
  std::mutex mutex_;
  std::exception_ptr error_;
};

SweepResult workOff(const Plan& plan, const SweepOptions& options)
{
  checkRuns(plan, options.watch);
  SweepDirectory directory(plan, options.out);
  directory.open();
  return runSweep(plan, directory, options);
}
}  // namespace

void addOptions(OptionTable& table, SweepOptions& options)
{
  table.add("plan", options.plan, "plan of the runs (docs/datasets.md)").required().type("PLAN.yaml");
  table.add("--out", options.out, "directory of runs and index; finished runs in it are kept").required().type("DIR");
  addJobsOption(table, options.jobs);
  table
      .add(
          "--shard", Option::Kind::TEXT,
          [&options](const std::string& text) { std::tie(options.shard, options.shards) = shardOf(text).value(); },
          "only the runs I, I + N, I + 2 N and so on, so that N processes can share the plan")
      .type("I/N")
      .check([](const std::string& text)
             { return shardOf(text) ? std::string() : "'" + text + "' must be I/N with 0 <= I < N"; });
  addOptions(table, static_cast<ConfigurationOptions&>(options));
}

void addJobsOption(OptionTable& table, unsigned& jobs)
{
  table.add("--jobs", jobs, "number of simultaneous runs").range(JOBS.min, JOBS.max);
}

RunSpec checkedRun(const Plan& plan, std::uint64_t run)
{
  try
  {
    return plan.run(run);
  }
  catch (const InputError& error)
  {
    throw InputError(std::string(error.what()) + " (run " + std::to_string(run) + " of " + std::to_string(plan.runs()) +
                     "; no run was started)");
  }
}

void checkRuns(const Plan& plan, const Watch& watch)
{
  for (std::uint64_t run = 0; run < plan.runs() && !watch.stopped(); ++run)
  {
    checkedRun(plan, run);
  }
}

SurfaceSource runSurfaces(const Plan& plan, unsigned jobs)
{
  return { plan.lives() != nullptr ? "" : surfaceCacheDirectory(), {}, {}, std::make_shared<SurfacePool>(jobs + 2) };
}

void requireLives(const Plan& plan, const std::string& path)
{
  if (plan.lives() == nullptr)
  {
    throw InputError(path + " has no mapping 'lives'; run it with joint_twin sweep");
  }
}

SweepResult sweep(const SweepOptions& options)
{
  return workOff(Plan(options.plan, options), options);
}

SweepResult sweepLives(const SweepOptions& options)
{
  const Plan plan(options.plan, options);
  requireLives(plan, options.plan);
  return workOff(plan, options);
}

SweepResult runSweep(const Plan& plan, SweepDirectory& directory, const SweepOptions& options)
{
  SweepResult result;
  result.index = directory.index();
  result.runs = plan.runs();
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
  directory.claim(todo);  // claims all runs before any work, so that one of two sweeps fails at once
  if (!todo.empty() && !options.watch.stopped())
  {
    Workers workers(plan, directory, todo, options.jobs);
    workers.work(options.watch);
    result.done = workers.done();
  }
  directory.writeIndex();
  for (std::uint64_t run = options.shard; run < plan.runs(); run += options.shards)
  {
    const OrderedJson record = directory.record(run);
    if (record.is_object())
    {
      result.failed += record.at("status") != "ok" ? 1 : 0;
      result.rows_without_forces += record.value(ROWS_WITHOUT_FORCES, std::uint64_t{});
    }
  }
  return result;
}

Json documentOf(const SweepResult& result)
{
  return { { "index", result.index },
           { "runs", result.runs },
           { "done", result.done },
           { "present", result.present },
           { "failed", result.failed },
           { "damaged", result.damaged },
           { ROWS_WITHOUT_FORCES, result.rows_without_forces } };
}
}  // namespace hjt
