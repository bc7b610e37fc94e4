// SPDX-License-Identifier: BSD-3-Clause
// Time of the whole cycle: stamped commands in, one solver step, outputs and per-tooth arrays out.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <time.h>

#include <nlohmann/json.hpp>

#include "apps/common/command.hpp"
#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "test/core/test_parameters.hpp"
#include "test/support/allocation_count.hpp"

namespace
{
/// Reads a clock of the system [s]. CLOCK_THREAD_CPUTIME_ID counts only the time this thread has had a processor for:
/// what a busy machine takes away does not count.
double readClock(clockid_t clock) noexcept
{
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// What the joint is made to do.
struct Scene
{
  std::string name;
  double load_torque;                              // [N.m]
  std::function<double(double time)> motor_speed;  // wanted [rad/s]
  bool brake{ false };                             // engaged, and the motor without current
};

// At 10 kHz a step at 157 rad/s turns the wave generator by half a tooth pitch: farthest from any shape met before.
const std::vector<Scene> SCENES{
  { "100 rad/s, load 40 N.m", 40.0, [](double) { return 100.0; } },
  { "157 rad/s, load 40 N.m", 40.0, [](double) { return 157.0; } },
  { "full speed 300 rad/s, load 40 N.m", 40.0, [](double) { return 300.0; } },
  { "reversing at 2 Hz, load 100 N.m", 100.0, [](double time) { return 60.0 * std::sin(2.0 * hjt::TWO_PI * time); } },
  { "standstill, brake on, load 40 N.m", 40.0, [](double) { return 0.0; }, true },
};

struct Result
{
  std::string scene;
  double simulated{};    // [s]
  double median{};       // of the time of one cycle [us]
  double p999{};         // [us]
  double max{};          // [us]
  double real_time{};    // simulated time over wall time [-]
  double one_core{};     // simulated time over processor time [-]
  double iterations{};   // Newton iterations, mean per step [-]
  double motor_speed{};  // largest reached [rad/s]
  std::size_t allocations{};
  std::uint64_t solver_failures{};
};

/// What is asked of the twin: every per-tooth array at every step, or encoders at 1 kHz and health, on the response
/// surface.
enum class Watch
{
  TEETH,
  ENCODERS
};

constexpr std::array<std::pair<const char*, Watch>, 2> WATCHES{ { { "teeth", Watch::TEETH },
                                                                  { "encoders", Watch::ENCODERS } } };

/// One cycle: a command, a step, and at every step every output and every per-tooth array, published or not; only the
/// health report keeps to its rate.
class Cycle
{
public:
  Cycle(const hjt::Parameters& parameters, const Scene& scene, Watch watch)
    : scene_(scene)
    , watch_(watch)
    , twin_(parameters, hjt::SurfaceSource{ hjt::surfaceCacheDirectory(), {}, {} })
    , forces_(twin_.makeToothForces())
    , encoder_interval_(std::max(1ll, std::llround(parameters.solver.rate / parameters.publish.encoders_rate)))
    , health_interval_(std::max(1ll, std::llround(parameters.solver.rate / parameters.publish.health_rate)))
    , reduced_load_(scene.load_torque / hjt::nominalRatio(parameters.gear))
  {
    twin_.commandBrake(0, scene.brake);
  }

  void run() noexcept
  {
    constexpr double GAIN = 0.2;  // of the speed controller [N.m.s/rad]
    const double time = 1e-9 * static_cast<double>(twin_.stamp());
    const double error = scene_.motor_speed(time) - outputs_.motor_velocity;
    const hjt::Stamp next = twin_.stamp() + twin_.stepLength();
    twin_.commandMotorTorque(next, scene_.brake ? 0.0 : reduced_load_ + GAIN * error);
    twin_.commandLoadTorque(next, scene_.load_torque);
    twin_.step(next);
    outputs_ = twin_.outputs();
    if (watch_ == Watch::TEETH)
    {
      twin_.toothForces(forces_);
    }
    if (watch_ == Watch::TEETH || twin_.counters().steps % encoder_interval_ == 0)
    {
      encoders_ = twin_.encoders();
    }
    if (twin_.counters().steps % health_interval_ == 0)
    {
      health_ = twin_.health();
    }
  }

  const hjt::Twin& twin() const { return twin_; }
  const hjt::JointOutputs& outputs() const { return outputs_; }

private:
  const Scene& scene_;
  Watch watch_;
  hjt::Twin twin_;
  hjt::JointOutputs outputs_;
  hjt::ToothForces forces_;
  hjt::EncoderReadings encoders_;
  hjt::HealthReport health_;
  std::uint64_t encoder_interval_;  // [steps]
  std::uint64_t health_interval_;   // [steps]
  double reduced_load_;             // [N.m]
};

/// `clock`: what single cycles are timed with.
/// On the surface a cycle is no longer than a look at the clock, so there a hundred are timed at once.
/// `joints`: so many twins that all make a cycle before the next.
Result measure(const hjt::Parameters& parameters, const Scene& scene, Watch watch, int joints, double duration,
               clockid_t clock)
{
  const std::size_t cycles = watch == Watch::TEETH ? 1 : 100;
  // Simulated until the speed is reached, or the swing has died away; timed is what comes after [s].
  const double run_up = scene.brake ? 2.0 : 0.25;
  const auto run_up_steps = static_cast<int>(run_up * parameters.solver.rate);
  const auto timed =
      static_cast<std::size_t>(std::max(1.0, duration * parameters.solver.rate / static_cast<double>(cycles)));
  const std::size_t steps = timed * cycles;
  std::vector<double> times(timed);
  Result result;
  std::vector<Cycle> twins;
  twins.reserve(static_cast<std::size_t>(joints));
  while (twins.size() < twins.capacity())
  {
    twins.emplace_back(parameters, scene, watch);
  }
  const Cycle& cycle = twins.front();
  const auto run = [&]
  {
    for (Cycle& each : twins)
    {
      each.run();
    }
  };
  std::uint64_t iterations = 0;

  const std::size_t allocations_before = hjt::allocationCount();
  for (int i = 0; i < run_up_steps; ++i)
  {
    run();
  }
  const double processor_start = readClock(CLOCK_THREAD_CPUTIME_ID);
  const double start = readClock(CLOCK_MONOTONIC);
  double before = readClock(clock);
  for (double& time : times)
  {
    for (std::size_t i = 0; i < cycles; ++i)
    {
      run();
      iterations += cycle.outputs().iterations;
    }
    const double after = readClock(clock);
    time = 1e6 * (after - before) / static_cast<double>(cycles);
    before = after;
    result.motor_speed = std::max(result.motor_speed, std::abs(cycle.outputs().motor_velocity));
  }
  const double wall_time = readClock(CLOCK_MONOTONIC) - start;
  const double processor_time = readClock(CLOCK_THREAD_CPUTIME_ID) - processor_start;
  result.allocations = hjt::allocationCount() - allocations_before;

  result.scene = (watch == Watch::TEETH ? "" : "surface: ") + scene.name;
  result.simulated = static_cast<double>(steps) / parameters.solver.rate;
  result.real_time = result.simulated / wall_time;
  result.one_core = result.simulated / processor_time;
  result.iterations = static_cast<double>(iterations) / static_cast<double>(steps);
  result.solver_failures = cycle.twin().counters().solver_failures;
  std::sort(times.begin(), times.end());
  result.median = times[timed / 2];
  result.p999 = times[std::min(timed - 1, static_cast<std::size_t>(0.999 * static_cast<double>(timed)))];
  result.max = times.back();
  return result;
}

void printTable(const std::vector<Result>& results)
{
  std::printf("%-44s %10s %10s %10s %10s %10s %10s %11s %9s\n", "cycle", "median us", "p99.9 us", "max us",
              "x realtime", "x one core", "iterations", "allocations", "failures");
  for (const Result& result : results)
  {
    std::printf("%-44s %10.3f %10.3f %10.1f %10.2f %10.2f %10.2f %11zu %9zu\n", result.scene.c_str(), result.median,
                result.p999, result.max, result.real_time, result.one_core, result.iterations, result.allocations,
                static_cast<std::size_t>(result.solver_failures));
  }
}

void printJson(const std::vector<Result>& results)
{
  nlohmann::json document = nlohmann::json::array();
  for (const Result& result : results)
  {
    document.push_back({ { "scene", result.scene },
                         { "simulated", result.simulated },
                         { "median_us", result.median },
                         { "p999_us", result.p999 },
                         { "max_us", result.max },
                         { "real_time_factor", result.real_time },
                         { "one_core_factor", result.one_core },
                         { "iterations", result.iterations },
                         { "motor_speed_max", result.motor_speed },
                         { "allocations", result.allocations },
                         { "solver_failures", result.solver_failures } });
  }
  std::cout << document.dump(2) << '\n';
}
}  // namespace

int main(int argc, char** argv)
{
  std::vector<std::string> assignments;
  double duration = 5.0;
  double least_speed = 0.0;
  int joints = 1;
  std::vector<std::string> watched;
  bool processor = false;
  bool json = false;
  hjt::CommandLine line(
      "joint_cycle_benchmark",
      "Time of the twin's whole cycle: every per-tooth array filled at every step; and on the response surface, only\n"
      "encoders and health asked for, twenty times as long.\n"
      "Exit code 1 if a cycle allocates, if the solver fails or if it is slower than asked for.");
  hjt::OptionTable& root = line.root();
  root.add("--set", assignments, "one parameter over the default configuration: section.key=value; repeatable");
  root.add("--duration", duration, "simulated time measured, per scene [s]").range(1e-3, 1e4);
  root.add("--least-speed", least_speed, "times real time that every scene must reach, by processor time")
      .range(0.0, 1e6);
  root.add("--joints", joints, "twins in one thread, one after the other at every step; a cycle is all of theirs")
      .range(1, 100);
  root.add("--watch", watched, "what is asked of the twin; default: both")
      .choice({ WATCHES[0].first, WATCHES[1].first });
  root.flag("--processor-time", processor,
            "time cycles by processor time: on a busy machine the wall clock times others too");
  root.flag("--json", json, "one JSON document on stdout and nothing else there");
  if (const std::optional<int> ended = line.parse(argc, argv))
  {
    return *ended;
  }

  std::vector<Result> results;
  try
  {
    const hjt::Parameters parameters = hjt::shippedParameters(assignments);
    for (const Scene& scene : SCENES)
    {
      for (const auto& [name, watch] : WATCHES)
      {
        if (!watched.empty() && std::find(watched.begin(), watched.end(), name) == watched.end())
        {
          continue;
        }
        hjt::Parameters given = parameters;
        given.solver.scene = watch == Watch::TEETH ? hjt::SceneKind::FULL_RING : hjt::SceneKind::AUTO;
        results.push_back(measure(given, scene, watch, joints, watch == Watch::TEETH ? duration : 20.0 * duration,
                                  processor ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC));
      }
    }
  }
  catch (const hjt::InputError& error)
  {
    std::cerr << error.what() << '\n';
    return 1;
  }
  json ? printJson(results) : printTable(results);
  const bool good =
      std::all_of(results.begin(), results.end(),
                  [&](const Result& result)
                  { return result.allocations == 0 && result.solver_failures == 0 && result.one_core >= least_speed; });
  return good ? 0 : 1;
}
