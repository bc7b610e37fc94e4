// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/run_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "base/temporary_directory.hpp"
#include "output/process_end.hpp"

#include "arm/arm_recorder.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
class RunSimulation::Drive : public Subject
{
public:
  Drive(const RunSpec& spec, const Recording& recording, const SurfaceSource& source)
    : recording_(recording), twin_(spec.parameters, source), feeder_(spec.duty, twin_)
  {
    twin_.watchSignals(recording.format == RunFormat::BAG);  // a bag contains the indicators from its start
    twin_.seekBearingSlip();
    twin_.reset(SIMULATION_EPOCH);
  }

  bool step(double time, Stamp end) override
  {
    feeder_.feed(twin_, time);
    if (recording_.indicators && time > recording_.start)
    {
      twin_.watchSignals(true);  // earlier, the first window would contain the start, unlike all other windows
    }
    return twin_.step(end);
  }
  void record(RunFile& file) override { file.record(twin_, feeder_); }
  const Twin& drive() const override { return twin_; }
  TwinCounters counters() const override { return twin_.counters(); }
  bool onSurface() const override { return twin_.onSurface(); }
  void tell(OrderedJson&) const override {}

private:
  const Recording& recording_;
  Twin twin_;
  DutyFeeder feeder_;
};

/// Simulates an arm. The run begins with the arm's motion, after its drives have settled.
class RunSimulation::Arm : public Subject
{
public:
  Arm(const RunSpec& spec, const SurfaceSource& source)
    : spec_(spec)
    , moving_(spec.arm->arm, spec.arm->drives, ArmMotion(*spec.arm->motion), source)
    , recorder_(spec.arm->arm, moving_)
  {
    moving_.reset(SIMULATION_EPOCH);
    while (moving_.step(moving_.motionBegin()))
    {
    }
  }

  bool step(double, Stamp end) override { return moving_.step(end); }
  void record(RunFile& file) override { file.record(moving_.twin().stamp(), recorder_); }
  const Twin& drive() const override { return moving_.twin().drive(0); }
  TwinCounters counters() const override { return countersOf(moving_.twin()); }
  bool onSurface() const override { return allOnSurface(moving_.twin()); }
  void tell(OrderedJson& record) const override { addProtectiveStop(spec_.arm->arm, moving_, record); }

private:
  const RunSpec& spec_;
  MovingArm moving_;
  ArmRecorder recorder_;
};

std::unique_ptr<RunSimulation::Subject> RunSimulation::begin(const RunSpec& spec) const
{
  if (spec.arm)
  {
    return std::make_unique<Arm>(spec, surface_source_);
  }
  return std::make_unique<Drive>(spec, plan_.recording(), surface_source_);
}

bool RunSimulation::simulate(std::uint64_t number)
{
  const RunSpec spec = plan_.run(number);
  OrderedJson record = recordOf(spec, directory_.runFileName(number));
  const std::string path = directory_.runFile(number);
  std::unique_ptr<Subject> subject;
  try
  {
    subject = begin(spec);
  }
  catch (const ParameterError& error)
  {
    record["status"] = "failed";
    record["error"] = error.what();
    makeRunFile(plan_.recording(), spec, nullptr, path)->finish(record);
    return true;
  }
  const auto file = makeRunFile(plan_.recording(), spec, &subject->drive(), path);
  const Stamp start = subject->drive().stamp();
  if (!march(*subject, spec, *file, Clock::time_point::max()))
  {
    return false;
  }
  addOutcome(subject->counters(), on_surface_, toSeconds(subject->drive().stamp() - start), record);
  subject->tell(record);
  file->finish(record);
  return true;
}

RunCost RunSimulation::sample(std::uint64_t number, double seconds)
{
  const auto since = [](Clock::time_point begin)
  { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const RunSpec spec = plan_.run(number);
  const TemporaryDirectory folder;
  const std::string path = folder.path() + "/run" + runFileExtension(plan_.recording().format);
  RunCost cost;
  const Clock::time_point first_begin = Clock::now();
  begin(spec);  // builds the response surfaces, which then exist for all runs
  cost.surfaces = since(first_begin);
  const Clock::time_point again = Clock::now();
  const std::unique_ptr<Subject> subject = begin(spec);
  const auto file = makeRunFile(plan_.recording(), spec, &subject->drive(), path);
  cost.ends = since(again);
  const Stamp start = subject->drive().stamp();
  const Clock::time_point marched = Clock::now();
  const auto budget = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  march(*subject, spec, *file, marched + budget);
  cost.real_time_factor = toSeconds(subject->drive().stamp() - start) / since(marched);
  const Clock::time_point marched_to = Clock::now();
  file->finish(recordOf(spec, path));
  cost.ends += since(marched_to);
  return cost;
}

/// Simulates the run step by step. @returns false if the run was stopped.
bool RunSimulation::march(Subject& subject, const RunSpec& spec, RunFile& file, Clock::time_point until)
{
  constexpr std::uint64_t STEPS_PER_LOOK = 1024;
  const Stamp end = subject.drive().stamp() + toStampLength(spec.duration);
  const double step = toSeconds(subject.drive().stepLength());
  const auto look = static_cast<std::uint64_t>(
      std::llround(std::min(1.0, STEPS_PER_LOOK * step / spec.duration) * static_cast<double>(WHOLE)));
  on_surface_ = 0;
  for (std::uint64_t steps = 1;; ++steps)
  {
    const double time = static_cast<double>(steps) * step;
    if (!subject.step(time, end))
    {
      return true;
    }
    on_surface_ += subject.onSurface() ? 1 : 0;
    if (subject.counters().solver_failures > 0)
    {
      return true;
    }
    subject.record(file);
    if (steps % STEPS_PER_LOOK == 0)
    {
      course_.simulated += look;
      if (course_.stop)
      {
        return false;
      }
      if (Clock::now() > until)
      {
        return true;
      }
    }
  }
}
}  // namespace hjt
