// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include "apps/common/configuration.hpp"
#include "apps/common/surface_source.hpp"
#include "apps/tool/torque_profile.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "output/run_summary.hpp"

#include "messages/time.hpp"
#include "studies/trial.hpp"

namespace hjt
{
namespace
{
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

const std::vector<Column<TrialSample>> SAMPLE_COLUMNS{ { "time", &TrialSample::time },
                                                       { "motor_angle", &TrialSample::motor_angle },
                                                       { "output_angle", &TrialSample::output_angle },
                                                       { "wave_generator_torque", &TrialSample::wave_generator_torque },
                                                       { "joint_torque", &TrialSample::joint_torque } };

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
    const InterruptScope interrupts;
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
  printReport(options.json,
              { { "finite", "every output finite", result.finite },
                { "solver_state", "solver, worst state", stateName(result.state) },
                { "steps", "steps", counters.steps },
                { "iterations_mean", "Newton iterations a step, mean", result.iterations_mean },
                { "iterations_max", "Newton iterations a step, most", result.iterations_max },
                { "step_cuts", "steps cut", counters.step_cuts },
                { "jumps", "steps in which teeth jumped", counters.jumps },
                { "coarse_steps", "steps too long for the motion", counters.coarse_steps },
                { "solver_failures", "steps failed", counters.solver_failures },
                { "speed_limited", "", counters.speed_limited },
                { "torque_clamped", "", counters.torque_clamped },
                { "load_clamped", "", counters.load_clamped },
                { "residual_max", "", result.residual_max },
                { "energy_residual_max", "energy residual, largest", result.energy_residual_max, "J" },
                { "throughput", "work of motor and load", result.throughput, "J" },
                { "substeps", "substeps a step", result.substeps },
                { "phase_advance_max", "swing of the joint a substep, largest", result.phase_advance_max, "rad" },
                { "wave_generator_turn_max", "turn of the wave generator a step, largest",
                  result.wave_generator_turn_max, "rad" },
                { "samples", "", Table(SAMPLE_COLUMNS, result.samples).columns() } });
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  return result.finite && counters.solver_failures == 0 ? EXIT_DONE : EXIT_FAILED;
}

void declare(Command& command, TrialOptions& options)
{
  command
      .add("--profile", options.profile,
           "CSV with columns time [s], motor_torque [N.m] and, if wanted, load_torque [N.m], brake (0 or 1); each row "
           "holds until the next")
      .required()
      .type("FILE.csv");
  command.add("--duration", options.duration, "simulated time [s]").required().range(1e-5, 1e4);
  command.add("--sample-period", options.sample_period, "between samples, a multiple of the step [s]").range(1e-6, 1e4);
  command.add("--advance", options.advance, "the profile begins this much earlier [s]").range(0.0, 1.0);
  addFaultOption(command, options);
  addCommonOptions(command, options);
}

const Subcommand TRIAL{ Subject::STUDY, "trial",
                        "run the twin under a profile and print the solver's messages, step by step", declare, trial };
}  // namespace
}  // namespace hjt
