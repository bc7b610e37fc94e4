// SPDX-License-Identifier: BSD-3-Clause
#include "apps/sweep/sweep.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <sstream>
#include <thread>

#include "apps/common/interrupt.hpp"
#include "apps/common/progress.hpp"
#include "apps/common/run_summary.hpp"
#include "apps/sweep/run_file.hpp"

#include "base/number_text.hpp"
#include "base/source_hash.hpp"
#include "base/text_hash.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "ros_io/time.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Version and hash of the code: runs made by another code are not added to.
std::string softwareVersion()
{
  return std::string(HJT_VERSION "+") + sourceHash();
}

constexpr const char* FORMAT = "harmonic_joint_twin data set 1";

std::string hexadecimal(std::uint64_t number)
{
  std::ostringstream text;
  text << std::hex << number;
  return text.str();
}

/// A cell of the index: texts in quotes, nothing for what is not there.
std::string cell(const Json& value)
{
  if (value.is_null())
  {
    return "";
  }
  if (value.is_number_float())
  {
    return numberText(value.get<double>());
  }
  if (!value.is_string())
  {
    return value.is_array() ? "\"" + value.dump() + "\"" : value.dump();
  }
  std::string text = value.get<std::string>();
  for (std::size_t at = 0; (at = text.find_first_of("\"\n", at)) != std::string::npos; at += 2)
  {
    text.replace(at, 1, text[at] == '"' ? "\"\"" : "; ");
  }
  return "\"" + text + "\"";
}

/// In what the document of a directory differs from that of a plan.
std::string otherThan(const Json& found, const Json& wanted)
{
  const std::array<std::pair<const char*, const char*>, 5> parts{ { { "format", "another format" },
                                                                    { "version", "another version of the software" },
                                                                    { "plan", "another plan" },
                                                                    { "tables", "other tables of the plan" },
                                                                    { "configuration", "another configuration" } } };
  for (const auto& [key, what] : parts)
  {
    if (!found.is_object() || found.value(key, Json()) != wanted.at(key))
    {
      return what;
    }
  }
  return "something else";
}

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
    const Recording& recording = plan_.recording();
    twin->watchSignals(recording.format == RunFormat::BAG || recording.indicators);  // a bag holds the indicators
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
    const Stamp end = SIMULATION_EPOCH + toStampLength(spec.duration);
    const double step = toSeconds(twin.stepLength());
    DutyFeeder feeder(spec.duty, twin);
    on_surface_ = 0;
    for (std::uint64_t steps = 1;; ++steps)
    {
      feeder.feed(twin, static_cast<double>(steps) * step);
      if (!twin.step(end))
      {
        return true;
      }
      on_surface_ += twin.onSurface() ? 1 : 0;
      if (!twin.outputs().converged)
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

void SweepDirectory::open() const
{
  const std::string name = path_ + "/plan.json";
  std::error_code error;
  fs::create_directories(path_ + "/runs", error);
  if (error)
  {
    throw InputError(path_ + " cannot be made: " + error.message());
  }
  Json document{ { "format", FORMAT }, { "version", softwareVersion() } };
  document.update(plan_.snapshot());
  const std::string text = document.dump(1) + '\n';
  // The plan is written before any run, perhaps by another shard at this moment: looked for in the opposite order.
  const bool empty = fs::is_empty(path_ + "/runs");
  std::ifstream file(name, std::ios::binary);
  if (!file)
  {
    if (!empty)
    {
      throw InputError(path_ + "/runs holds files of something else, and there is no plan.json; give another --out");
    }
    writeTextFile(name, text);
    return;
  }
  const std::string found((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (found != text)
  {
    throw InputError(name + " is of " + otherThan(Json::parse(found, nullptr, false), document) +
                     "; give another --out");
  }
}

std::string SweepDirectory::runFileName(std::uint64_t run) const
{
  char number[32];
  std::snprintf(number, sizeof(number), "%09llu", static_cast<unsigned long long>(run));
  return std::string("runs/run_") + number + runFileExtension(plan_.recording().format);
}

std::string SweepDirectory::runFile(std::uint64_t run) const
{
  return path_ + "/" + runFileName(run);
}

Json SweepDirectory::record(std::uint64_t run) const
{
  return readRunRecord(plan_.recording().format, runFile(run));
}

std::uint64_t SweepDirectory::finishedRuns() const
{
  std::uint64_t finished = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_ + "/runs"))
  {
    finished += entry.path().extension() == runFileExtension(plan_.recording().format) ? 1 : 0;
  }
  return finished;
}

std::string SweepDirectory::indexHeader() const
{
  std::string header =
      "run,file,status,class,duty,repeat,duration,fault_kind,fault_severity,fault_place,fault_onset,noise_seed,"
      "parameters_hash,version,error";
  for (const std::string& name : plan_.variableNames())
  {
    header += "," + name;
  }
  return header;
}

std::string SweepDirectory::indexRow(const Json& record) const
{
  std::string row = cell(record.at("run"));
  for (const char* key : { "file", "status", "class", "duty", "repeat", "duration" })
  {
    row += "," + cell(record.at(key));
  }
  for (const char* key : { "kind", "severity", "place", "onset" })
  {
    std::string list;
    for (const Json& fault : record.at("faults"))
    {
      list += (list.empty() ? "" : ";") +
              (fault.at(key).is_string() ? fault.at(key).get<std::string>() : cell(fault.at(key)));
    }
    row += "," + list;
  }
  for (const char* key : { "noise_seed", "parameters_hash", "version", "error" })
  {
    row += "," + cell(record.at(key));
  }
  for (const std::string& name : plan_.variableNames())
  {
    row += "," + cell(record.at("variables").value(name, Json()));
  }
  return row;
}

void SweepDirectory::writeIndex() const
{
  // Another shard may end while this one reads: whoever writes last has seen all.
  for (std::uint64_t seen = 0, now = finishedRuns(); seen != now; now = finishedRuns())
  {
    seen = now;
    std::string text = indexHeader() + '\n';
    for (std::uint64_t run = 0; run < plan_.runs(); ++run)
    {
      const Json found = record(run);
      if (found.is_object())
      {
        text += indexRow(found) + '\n';
      }
    }
    writeTextFile(path_ + "/index.csv", text);
  }
}

Json recordOf(const RunSpec& spec, const std::string& file)
{
  Json variables = Json::object();
  for (const auto& [name, value] : spec.variables)
  {
    variables[name] = jsonOf(value);
  }
  Json faults = Json::array();
  for (const FaultLabel& fault : spec.faults)
  {
    faults.push_back(
        { { "kind", fault.kind }, { "severity", fault.severity }, { "place", fault.place }, { "onset", fault.onset } });
  }
  return { { "format", FORMAT },
           { "version", softwareVersion() },
           { "run", spec.run },
           { "file", file },
           { "status", "ok" },
           { "error", "" },
           { "class", spec.fault_class },
           { "duty", spec.duty_name },
           { "repeat", spec.repeat },
           { "duration", spec.duration },
           { "faults", faults },
           { "variables", variables },
           { "noise_seed", spec.parameters.sensors.noise_seed },
           { "parameters_hash", hexadecimal(textHash(describeParameters(spec.parameters))) } };
}

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
  Twin first(spec.parameters, surface_source);  // may have to build its surface, once for all runs
  const Clock::time_point begin = Clock::now();
  Twin twin(spec.parameters, surface_source);
  RunCost cost;
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

SweepResult runSweep(const Plan& plan, const SweepDirectory& directory, const SweepOptions& options,
                     const SurfaceSource& surface_source)
{
  SweepResult result;
  std::vector<std::uint64_t> todo;
  for (std::uint64_t run = options.shard; run < plan.runs(); run += options.shards)
  {
    if (directory.record(run).is_object())
    {
      ++result.present;
    }
    else
    {
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
