// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/common/configuration.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/progress.hpp"
#include "apps/common/text_table.hpp"
#include "apps/tool/commands.hpp"

#include "harmonic_joint_twin/base/errors.hpp"
#include "life/drive_ageing.hpp"
#include "studies/life_trials.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

struct LifeOptions : CommonOptions
{
  std::string duty;
  std::string csv;
  double hours{ 1e6 };
  int positions{ 16 };
  bool grease_changes{};
};

struct AgeOptions : LifeOptions
{
  double every{ 100.0 };
  bool check{};
};

struct TrialsOptions : LifeOptions
{
  LifeTrialOptions trials{ 100, 1, 250.0, 2000, 1e-6, 0.05, false };
};

/// Everything a life is computed from.
struct LifeBench
{
  explicit LifeBench(const LifeOptions& options)
    : parameters(loadParameters(options))
    , duty(DutyCycle::fromFile(options.duty))
    , exposures(measure(parameters, duty, options.positions))
    , ageing(parameters.life, parameters.gear, duty, exposures)
  {
  }

  static ExposureMap measure(const Parameters& parameters, const DutyCycle& duty, int positions)
  {
    Progress progress("measuring wear");
    ExposureMap exposures(parameters, positions);
    exposures.cover(duty, [&](double done) { progress.update(done); });
    return exposures;
  }

  Parameters parameters;
  DutyCycle duty;
  ExposureMap exposures;
  DriveAgeing ageing;
};

int age(const AgeOptions& options)
{
  if (!options.csv.empty())
  {
    requireWritable(options.csv, options.force, options.duty);
  }
  const LifeBench bench(options);
  const DriveNature nature = nominalDrive(bench.parameters.life);
  std::vector<std::vector<double>> rows;
  const DriveAgeing::Life life = bench.ageing.live(
      nature, options.hours, options.every, options.grease_changes,
      [&](double hours, const DriveAge& then)
      {
        rows.push_back({ hours, then.turns, then.flank_wear, then.interface_wear, then.grease, then.flaw_depth,
                         then.bearing_turns, BearingLife(bench.parameters.life).failedBy(then.bearing_turns),
                         spallSize(nature, then.bearing_turns) });
      });
  const std::vector<std::string> columns{ "hours",      "turns",         "flank_wear",      "interface_wear", "grease",
                                          "flaw_depth", "bearing_turns", "bearings_failed", "spall" };
  if (!options.csv.empty())
  {
    CsvWriter csv(options.csv, columns);
    for (const std::vector<double>& row : rows)
    {
      csv.writeRow(row);
    }
    csv.close();
  }
  const double map_error = options.check ? bench.exposures.largestError() : 0.0;
  if (options.json)
  {
    Json phases = Json::array();
    for (const DutyPhase& phase : bench.duty.phases)
    {
      const Exposure fresh = bench.exposures.at(phase.load_torque, 0.0, 0.0);
      phases.push_back({ { "load_torque", phase.load_torque },
                         { "turns_per_cycle", phase.turns() },
                         { "flank_sliding", fresh.flank_sliding },
                         { "interface_sliding", fresh.interface_sliding },
                         { "rim_stress_range", fresh.rim_stress_range } });
    }
    Json result{ { "hours", life.hours },
                 { "end", nameOf(life.end) },
                 { "turns", life.age.turns },
                 { "flank_wear", life.age.flank_wear },
                 { "interface_wear", life.age.interface_wear },
                 { "flaw_depth", life.age.flaw_depth },
                 { "phases", phases } };
    if (options.check)
    {
      result["map_error"] = map_error;
    }
    std::cout << result.dump(2) << '\n';
    return EXIT_DONE;
  }
  std::vector<NamedValue> values{ { "hours of use", shortNumber(life.hours), "h" },
                                  { "end", nameOf(life.end), "" },
                                  { "turns of the motor", shortNumber(life.age.turns), "" },
                                  { "flank wear", shortNumber(life.age.flank_wear), "m" },
                                  { "interface wear", shortNumber(life.age.interface_wear), "m" },
                                  { "flaw at the tooth root", shortNumber(life.age.flaw_depth), "m" },
                                  { "bearings failed by then",
                                    shortNumber(BearingLife(bench.parameters.life).failedBy(life.age.bearing_turns)),
                                    "" } };
  if (options.check)
  {
    values.push_back({ "largest error of the exposure map", shortNumber(map_error), "" });
  }
  printValues(values);
  return EXIT_DONE;
}

int trials(const TrialsOptions& options)
{
  if (!options.csv.empty())
  {
    requireWritable(options.csv, options.force, options.duty);
  }
  const LifeBench bench(options);
  LifeTrialOptions trial_options = options.trials;
  trial_options.grease_changes = options.grease_changes;
  std::vector<LifeTrial> lives;
  {
    Progress progress("living");
    lives = runLifeTrials(bench.parameters, bench.ageing, trial_options, options.hours,
                          [&](double done) { progress.update(done); });
  }
  std::array<int, 4> ends{};
  int unended = 0;
  for (const LifeTrial& trial : lives)
  {
    trial.life.end ? ++ends[static_cast<std::size_t>(*trial.life.end)] : ++unended;
  }
  const Coverage all = coverage(lives, 0.0);
  const Coverage later = coverage(lives, 0.5);
  if (!options.csv.empty())
  {
    CsvWriter csv(options.csv, { "life", "hours", "remaining", "q05", "q10", "q50", "q90", "q95", "flank", "interface",
                                 "bearing", "end" });
    for (std::size_t i = 0; i < lives.size(); ++i)
    {
      for (const LifeForecast& forecast : lives[i].forecasts)
      {
        const RemainingHours& said_then = forecast.forecast;
        csv.writeRow({ static_cast<double>(i), forecast.hours, forecast.remaining, said_then.quantile[0],
                       said_then.quantile[1], said_then.quantile[2], said_then.quantile[3], said_then.quantile[4],
                       said_then.by_cause[0], said_then.by_cause[1], said_then.by_cause[2],
                       static_cast<double>(*lives[i].life.end) });
      }
    }
    csv.close();
  }
  if (options.json)
  {
    std::cout << Json{
      { "lives", lives.size() },     { "unended", unended },         { "flank_wear", ends[0] },
      { "interface_wear", ends[1] }, { "root_crack", ends[2] },      { "bearing", ends[3] },
      { "forecasts", all.said },     { "coverage_80", all.share() }, { "coverage_80_from_half_life", later.share() }
    }.dump(2) << '\n';
    return EXIT_DONE;
  }
  printValues({ { "lives", std::to_string(lives.size()), "" },
                { "ended by flank wear", std::to_string(ends[0]), "" },
                { "ended by interface wear", std::to_string(ends[1]), "" },
                { "ended by a root crack", std::to_string(ends[2]), "" },
                { "ended by the bearing", std::to_string(ends[3]), "" },
                { "still in use at the end", std::to_string(unended), "" },
                { "forecasts", std::to_string(all.said), "" },
                { "the 80 % interval held the truth", shortNumber(100.0 * all.share()), "%" },
                { "from half of each life on", shortNumber(100.0 * later.share()), "%" } });
  return EXIT_DONE;
}

void addLifeOptions(CLI::App& command, LifeOptions& options)
{
  command
      .add_option(
          "DUTY", options.duty,
          "CSV file of what the joint does over and over: duration [s], motor_speed [rad/s], load_torque [N.m], "
          "temperature [degC]")
      ->required()
      ->check(CLI::ExistingFile);
  command.add_option("--hours", options.hours, "longest use [h], default 1e6: to the end")
      ->check(CLI::Range(1e-3, 1e9));
  command
      .add_option("--positions", options.positions, "wave generator angles per tooth pitch that are averaged over [16]")
      ->check(CLI::Range(1, 100000));
  command.add_flag("--grease-changes", options.grease_changes, "the grease is changed whenever it is due");
  command.add_option("--csv", options.csv, "file to write the rows to");
  addCommonOptions(command, options);
}
}  // namespace

void addLifeCommand(CLI::App& app, int& exit_code)
{
  auto* life = app.add_subcommand("life", "wear over years of a duty cycle, and how well remaining life is forecast");
  life->require_subcommand(1);

  const auto age_options = std::make_shared<AgeOptions>();
  auto* age_command = life->add_subcommand("age", "the nominal drive, from new to the end of its use");
  addLifeOptions(*age_command, *age_options);
  age_command->add_option("--every", age_options->every, "hours between rows [100]")->check(CLI::Range(1e-3, 1e9));
  age_command->add_flag("--check", age_options->check,
                        "also measure how far the map between the stages of wear is off (some seconds)");
  age_command->callback([age_options, &exit_code] { exit_code = age(*age_options); });

  const auto trials_options = std::make_shared<TrialsOptions>();
  auto* trials_command = life->add_subcommand(
      "trials", "drives drawn from the spread of the parameters, each watched by the forecast of its remaining life");
  LifeTrialOptions& trial = trials_options->trials;
  addLifeOptions(*trials_command, *trials_options);
  trials_command->add_option("--lives", trial.lives, "drives [100]")->check(CLI::Range(1, 1000000));
  trials_command->add_option("--seed", trial.seed, "of all that is drawn [1]");
  trials_command->add_option("--every", trial.every, "hours of use between two readings [250]")
      ->check(CLI::Range(1e-3, 1e9));
  trials_command->add_option("--particles", trial.particles, "of the filter [2000]")->check(CLI::Range(10, 1000000));
  trials_command->add_option("--flank-wear-error", trial.flank_wear_error, "of one reading, one sigma [1e-6 m]")
      ->check(CLI::Range(1e-9, 1e-3));
  trials_command
      ->add_option("--spall-error", trial.spall_error, "of one reading, one sigma, of its size at the end [0.05]")
      ->check(CLI::Range(1e-6, 10.0));
  trials_command->callback([trials_options, &exit_code] { exit_code = trials(*trials_options); });
}
}  // namespace hjt
