// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/common/configuration.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/progress.hpp"
#include "apps/common/run_summary.hpp"
#include "apps/common/surface_source.hpp"
#include "apps/common/text_table.hpp"
#include "apps/common/validators.hpp"
#include "apps/tool/commands.hpp"
#include "apps/tool/torque_profile.hpp"

#include "ros_io/time.hpp"
#include "studies/trial.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

struct TrialOptions : CommonOptions
{
  std::string profile;
  double duration{};
  double sample_period{ 1e-3 };
  double advance{};
};

const char* stateName(SolverState state)
{
  return state == SolverState::OK ? "ok" : state == SolverState::DEGRADED ? "degraded" : "failed";
}

Json samplesOf(const TrialResult& result)
{
  Json samples{ { "time", Json::array() },
                { "motor_angle", Json::array() },
                { "output_angle", Json::array() },
                { "wave_generator_torque", Json::array() },
                { "joint_torque", Json::array() } };
  for (const TrialSample& sample : result.samples)
  {
    samples["time"].push_back(sample.time);
    samples["motor_angle"].push_back(sample.motor_angle);
    samples["output_angle"].push_back(sample.output_angle);
    samples["wave_generator_torque"].push_back(sample.wave_generator_torque);
    samples["joint_torque"].push_back(sample.joint_torque);
  }
  return samples;
}

int trial(const TrialOptions& options)
{
  const Parameters parameters = loadParameters(options);
  TorqueProfile profile = TorqueProfile::fromFile(options.profile);
  Twin twin(parameters, surfaceSource());
  twin.reset(SIMULATION_EPOCH);
  const Stamp begin = twin.stamp();
  const Stamp end = begin + toStampLength(options.duration);
  const Stamp profile_begin = begin - toStampLength(options.advance);
  TrialResult result;
  {
    Progress progress("running");
    result =
        runTrial(twin, end, toStampLength(options.sample_period),
                 [&](Twin& running)
                 {
                   profile.feed(running, profile_begin);
                   progress.update(static_cast<double>(running.stamp() - begin) / static_cast<double>(end - begin));
                   return interruptSignal() == 0;
                 });
  }
  const TwinCounters& counters = result.counters;
  if (options.json)
  {
    std::cout << Json{
      { "finite", result.finite },
      { "solver_state", stateName(result.state) },
      { "steps", counters.steps },
      { "iterations_mean", result.iterations_mean },
      { "iterations_max", result.iterations_max },
      { "step_cuts", counters.step_cuts },
      { "jumps", counters.jumps },
      { "coarse_steps", counters.coarse_steps },
      { "solver_failures", counters.solver_failures },
      { "speed_limited", counters.speed_limited },
      { "torque_clamped", counters.torque_clamped },
      { "load_clamped", counters.load_clamped },
      { "residual_max", result.residual_max },
      { "energy_residual_max", result.energy_residual_max },
      { "throughput", result.throughput },
      { "swing_phase_max", result.swing_phase_max },
      { "wave_generator_turn_max", result.wave_generator_turn_max },
      { "samples", samplesOf(result) }
    }.dump(2) << '\n';
  }
  else
  {
    printValues(
        { { "every output finite", result.finite ? "yes" : "no", "" },
          { "solver, worst state", stateName(result.state), "" },
          { "steps", std::to_string(counters.steps), "" },
          { "Newton iterations a step, mean", shortNumber(result.iterations_mean), "" },
          { "Newton iterations a step, most", std::to_string(result.iterations_max), "" },
          { "steps cut", std::to_string(counters.step_cuts), "" },
          { "steps in which teeth jumped", std::to_string(counters.jumps), "" },
          { "steps too long for the motion", std::to_string(counters.coarse_steps), "" },
          { "steps failed", std::to_string(counters.solver_failures), "" },
          { "energy residual, largest", shortNumber(result.energy_residual_max), "J" },
          { "work of motor and load", shortNumber(result.throughput), "J" },
          { "swing of the joint a step, largest", shortNumber(result.swing_phase_max), "rad" },
          { "turn of the wave generator a step, largest", shortNumber(result.wave_generator_turn_max), "rad" } });
  }
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  return result.finite && counters.solver_failures == 0 ? EXIT_DONE : EXIT_FAILED;
}
}  // namespace

void addTrialCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<TrialOptions>();
  auto* command =
      app.add_subcommand("trial", "run the twin under a profile and tell what its solver said, step by step");
  command
      ->add_option("--profile", options->profile,
                   "CSV with columns time [s], motor_torque [N.m] and, if wanted, load_torque [N.m], brake (0 or 1); "
                   "each row holds until the next")
      ->required()
      ->type_name("FILE.csv");
  command->add_option("--duration", options->duration, "simulated time [s]")->required()->check(CLI::Range(1e-5, 1e4));
  command->add_option("--sample-period", options->sample_period, "between samples, a multiple of the step [s]")
      ->capture_default_str()
      ->check(CLI::Range(1e-6, 1e4));
  command->add_option("--advance", options->advance, "the profile begins this much earlier [s]")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  addFaultOption(*command, *options);
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = trial(*options); });
}
}  // namespace hjt
