// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "apps/common/configuration.hpp"
#include "output/process_end.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"

#include "life/drive_ageing.hpp"
#include "life/revolution_load_map.hpp"
#include "statics/flexspline_stress.hpp"
#include "studies/life_trials.hpp"

namespace hjt
{
namespace
{
const Subcommand LIFE{ Subject::STUDY, "life",
                       "wear over years of a duty cycle, and accuracy of the forecast of remaining life" };

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
  LifeTrialOptions trials;
};

struct LifeBench
{
  explicit LifeBench(const LifeOptions& options)
    : parameters(loadParameters(options))
    , duty(DutyCycle::fromFile(options.duty))
    , load_map(measure(parameters, duty, options.positions))
    , ageing(parameters, duty, load_map)
  {
  }

  static RevolutionLoadMap measure(const Parameters& parameters, const DutyCycle& duty, int positions)
  {
    RevolutionLoadMap load_map(parameters, positions);
    load_map.cover(duty, showProgress("measuring wear"));
    return load_map;
  }

  Parameters parameters;
  DutyCycle duty;
  RevolutionLoadMap load_map;
  DriveAgeing ageing;
};

/// State of the nominal drive after some hours of use.
struct AgeRow
{
  double hours{};
  DriveAge age;
  double bearings_failed{};
  double spall{};
};
Column<AgeRow> ofAge(const char* key, double DriveAge::*value)
{
  return { key, [value](const AgeRow& row) { return row.age.*value; } };
}
Column<AgeRow> fatigueColumn(const char* key, StressPlace place)
{
  return { key, [place](const AgeRow& row) { return row.age.fatigue[static_cast<std::size_t>(place)]; } };
}
const std::vector<Column<AgeRow>> AGE_COLUMNS{
  { "hours", &AgeRow::hours },
  ofAge("turns", &DriveAge::turns),
  { "flank_wear", [](const AgeRow& row) { return row.age.worstFlank(); } },
  { "flank_wear_positive", [](const AgeRow& row) { return row.age.flank_wear[0]; } },
  { "flank_wear_negative", [](const AgeRow& row) { return row.age.flank_wear[1]; } },
  ofAge("interface_wear", &DriveAge::interface_wear),
  ofAge("grease", &DriveAge::grease),
  ofAge("flaw_depth", &DriveAge::flaw_depth),
  ofAge("bearing_turns", &DriveAge::bearing_turns),
  { "bearings_failed", &AgeRow::bearings_failed },
  { "spall", &AgeRow::spall },
  fatigueColumn("fatigue_tooth_space", StressPlace::TOOTH_SPACE),
  fatigueColumn("fatigue_transition", StressPlace::TRANSITION),
  fatigueColumn("fatigue_flange", StressPlace::FLANGE)
};

/// Stress of the new flexspline at one place, under one load, over a turn of the motor, and the cycles to failure.
struct FatigueRow
{
  double torque{};
  std::size_t place{};
  StressCycle cycle;
  double equivalent{};   ///< amplitude with zero mean stress that damages the notch as `cycle` does [Pa]
  double cycles{};       ///< number of cycles that half of all flexsplines endure; infinite below the endurance limit
  double cycles_weak{};  ///< number of cycles that 99 % of all flexsplines endure [-]
  double allowed{};      ///< number of cycles that the catalogue allows; infinite up to the repeated peak torque
};
const std::vector<Column<FatigueRow>> FATIGUE_COLUMNS{
  { "torque", &FatigueRow::torque, "torque [N.m]" },
  { "place", [](const FatigueRow& row) { return STRESS_PLACE_NAMES[row.place]; }, "place" },
  { "amplitude", [](const FatigueRow& row) { return row.cycle.amplitude(); }, "amplitude [Pa]" },
  { "mean", [](const FatigueRow& row) { return row.cycle.mean(); }, "mean [Pa]" },
  { "shear", [](const FatigueRow& row) { return row.cycle.shear; }, "shear [Pa]" },
  { "equivalent", &FatigueRow::equivalent, "equivalent at notch [Pa]" },
  { "cycles", &FatigueRow::cycles, "cycles, median [-]" },
  { "cycles_weak", &FatigueRow::cycles_weak, "cycles, weakest 1 % [-]" },
  { "allowed", &FatigueRow::allowed, "cycles, catalogue [-]" }
};

std::vector<FatigueRow> fatigueRows(const Parameters& parameters, double torque, const RevolutionLoad& revolution_load)
{
  constexpr double WEAKEST_HUNDREDTH = -2.326;  // 1 % quantile of the normal distribution [standard deviations]
  const FatigueLaw fatigue_law(parameters.life, parameters.stress);
  const double weak = std::exp(WEAKEST_HUNDREDTH * parameters.life.fatigue_spread);
  const auto lasts = [&](double share) { return 1.0 / fatigue_law.damage(share, false); };
  std::vector<FatigueRow> rows;
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    const StressCycle& cycle = revolution_load.stress[place];
    const double share = fatigue_law.enduranceShare(place, cycle);
    const double allowed =
        std::abs(torque) <= parameters.life.repeated_peak_torque  ? HUGE_VAL :
        std::abs(torque) <= parameters.life.momentary_peak_torque ? parameters.life.momentary_peak_cycles :
                                                                    0.0;
    rows.push_back({ torque, place, cycle, fatigue_law.equivalentAmplitude(place, cycle), lasts(share),
                     lasts(share / weak), allowed });
  }
  return rows;
}

/// A phase of the duty cycle, with the sliding and fatigue that it causes in a new drive.
struct FreshPhase
{
  DutyPhase phase;
  RevolutionLoad revolution_load;
  std::vector<FatigueRow> fatigue;
};
const std::vector<Column<FreshPhase>> PHASE_COLUMNS{
  { "load_torque", [](const FreshPhase& fresh) { return fresh.phase.load_torque; } },
  { "turns_per_cycle", [](const FreshPhase& fresh) { return fresh.phase.turns(); } },
  { "flank_sliding", [](const FreshPhase& fresh) { return fresh.revolution_load.flank_sliding; } },
  { "interface_sliding", [](const FreshPhase& fresh) { return fresh.revolution_load.interface_sliding; } },
  { "race_creep", [](const FreshPhase& fresh) { return fresh.revolution_load.race_creep; } },
  { "fatigue", [](const FreshPhase& fresh) { return Table(FATIGUE_COLUMNS, fresh.fatigue).rows(); } }
};

struct FatigueOptions : CommonOptions
{
  std::vector<double> torques;
  int positions{ 16 };
};

int fatigue(const FatigueOptions& options)
{
  const Parameters parameters = loadParameters(options);
  const LifeParameters& life = parameters.life;
  RevolutionLoadAnalysis analysis(parameters, options.positions);
  std::vector<FatigueRow> rows;
  for (const double torque :
       options.torques.empty() ?
           std::vector<double>{ life.rated_torque, life.repeated_peak_torque, life.momentary_peak_torque } :
           options.torques)
  {
    for (const FatigueRow& row : fatigueRows(parameters, torque, analysis.under(torque)))
    {
      rows.push_back(row);
    }
  }
  printReport(options.json, {}, { { "rows", { FATIGUE_COLUMNS, rows } } });
  return EXIT_DONE;
}

void declareFatigue(OptionTable& table, FatigueOptions& options)
{
  table.add("--torques", options.torques,
            "loads at the output [N.m]; default: rated, repeated and momentary peak torque of the catalogue");
  table.add("--positions", options.positions, "number of wave generator angles per tooth pitch").range(1, 100000);
  addCommonOptions(table, options);
}

const Subcommand FATIGUE{ Subject::STUDY, "life fatigue",
                          "stress of the flexspline over a turn, and its number of cycles to failure", declareFatigue,
                          fatigue };

int age(const AgeOptions& options)
{
  requireWritable(options.csv, options.force, options.duty);
  const LifeBench bench(options);
  const UnitVariation variation = nominalDrive(bench.parameters.life);
  const BearingLife bearing(bench.parameters.life);
  std::vector<AgeRow> rows;
  const DriveAgeing::Life life = bench.ageing.live(
      variation, options.hours, options.every, options.grease_changes,
      [&](double hours, const DriveAge& then) {
        rows.push_back({ hours, then, bearing.failedBy(then.bearing_turns), spallSize(variation, then.bearing_turns) });
      });
  writeTable(options.csv, AGE_COLUMNS, rows);
  std::vector<FreshPhase> phases;
  for (const DutyPhase& phase : bench.duty.phases)
  {
    const RevolutionLoad fresh = bench.load_map.at(phase.load_torque, 0.0, 0.0);
    phases.push_back({ phase, fresh, fatigueRows(bench.parameters, phase.load_torque, fresh) });
  }
  std::vector<ReportLine> lines{
    { "hours", "hours of use", life.hours, "h" },
    { "end", "end", nameOf(life.end) },
    { "turns", "turns of the motor", life.age.turns },
    { "flank_wear", "flank wear", life.age.worstFlank(), "m" },
    { "interface_wear", "interface wear", life.age.interface_wear, "m" },
    { "flaw_depth", "crack at the tooth root", life.age.flaw_depth, "m" },
    { "fatigue", "fatigue of the flexspline (1: broken)",
      *std::max_element(life.age.fatigue.begin(), life.age.fatigue.end()) },
    { "", "share of bearings that fail within the hours of use", bearing.failedBy(life.age.bearing_turns) },
    { "phases", "", Table(PHASE_COLUMNS, phases).rows() },
  };
  if (options.check)
  {
    lines.push_back({ "map_error", "largest error of the interpolated loads", bench.load_map.largestError() });
  }
  printReport(options.json, lines);
  return EXIT_DONE;
}

/// Writes to a CSV file all forecasts for the drives whose life ended.
void writeForecasts(const std::string& path, const std::vector<LifeTrial>& lives)
{
  CsvWriter csv(path,
                { "life",     "hours",    "remaining", "end",       "level",     "cause",     "severity",  "q05",
                  "q10",      "q50",      "q90",       "q95",       "crps",      "read_q05",  "read_q10",  "read_q50",
                  "read_q90", "read_q95", "read_crps", "prior_q10", "prior_q50", "prior_q90", "prior_crps" });
  for (std::size_t i = 0; i < lives.size(); ++i)
  {
    for (const LifeForecast& forecast : lives[i].forecasts)
    {
      const auto& quantile = forecast.forecast.quantile;
      const auto& read = forecast.read.quantile;
      const auto& prior = forecast.prior.quantile;
      csv.writeRow({ static_cast<double>(i),
                     forecast.hours,
                     forecast.remaining,
                     static_cast<double>(*lives[i].life.end),
                     static_cast<double>(forecast.assessment.level),
                     static_cast<double>(forecast.assessment.cause),
                     forecast.assessment.severity,
                     quantile[0],
                     quantile[1],
                     quantile[2],
                     quantile[3],
                     quantile[4],
                     forecast.forecast.crps(forecast.remaining),
                     read[0],
                     read[1],
                     read[2],
                     read[3],
                     read[4],
                     forecast.read.crps(forecast.remaining),
                     prior[1],
                     prior[2],
                     prior[3],
                     forecast.prior.crps(forecast.remaining) });
    }
  }
  csv.close();
}

int trials(const TrialsOptions& options)
{
  requireWritable(options.csv, options.force, options.duty);
  const LifeBench bench(options);
  LifeTrialOptions trial_options = options.trials;
  trial_options.grease_changes = options.grease_changes;
  const std::vector<LifeTrial> lives =
      runLifeTrials(bench.parameters, bench.ageing, trial_options, options.hours, showProgress("living"));
  std::array<int, ENDS_OF_LIFE> ends{};
  int unended = 0;
  for (const LifeTrial& trial : lives)
  {
    trial.life.end ? ++ends[static_cast<std::size_t>(*trial.life.end)] : ++unended;
  }
  if (!options.csv.empty())
  {
    writeForecasts(options.csv, lives);
  }
  const Coverage all = coverage(lives, 0.0);
  const Coverage later = coverage(lives, 0.5);
  printReport(options.json,
              { { "lives", "lives", lives.size() },
                { "flank_wear", "ended by flank wear", ends[0] },
                { "interface_wear", "ended by interface wear", ends[1] },
                { "root_crack", "ended by a root crack", ends[2] },
                { "bearing", "ended by the bearing", ends[3] },
                { "tooth_space_fatigue", "ended by fatigue in the tooth space", ends[4] },
                { "transition_fatigue", "ended by fatigue where the rim meets the cup", ends[5] },
                { "flange_fatigue", "ended by fatigue at the flange", ends[6] },
                { "unended", "still in use at the end", unended },
                { "forecasts", "forecasts", all.forecasts },
                { "coverage_80", "", all.share() },
                { "coverage_80_from_half_life", "", later.share() },
                { "", "coverage of the 80 % intervals, all forecasts", 100.0 * all.share(), "%" },
                { "", "coverage of the 80 % intervals, second half of lives", 100.0 * later.share(), "%" } });
  return EXIT_DONE;
}

void declareLife(OptionTable& table, LifeOptions& options)
{
  table
      .add("DUTY", options.duty,
           "CSV file of a duty cycle, which is repeated; columns: duration [s], motor_speed [rad/s], "
           "load_torque [N.m], temperature [degC]")
      .required()
      .existingFile();
  table.add("--hours", options.hours, "longest duration of use [h]").range(1e-3, 1e9);
  table
      .add("--positions", options.positions,
           "number of wave generator angles per tooth pitch, over which the program averages the drive's loads")
      .range(1, 100000);
  table.flag("--grease-changes", options.grease_changes, "change the grease whenever it is due");
  table.add("--csv", options.csv, "file for the state of the drive over the hours of use");
  addCommonOptions(table, options);
}

void declareAge(OptionTable& table, AgeOptions& options)
{
  declareLife(table, options);
  table.add("--every", options.every, "hours of use between two rows").range(1e-3, 1e9);
  table.flag("--check", options.check,
             "also compute the error of the loads that are interpolated between stages of wear (takes some seconds)");
}

const Subcommand AGE{ Subject::STUDY, "life age", "life of the nominal drive, from new to its end", declareAge, age };

void declareTrials(OptionTable& table, TrialsOptions& options)
{
  declareLife(table, options);
  LifeTrialOptions& trial = options.trials;
  table.add("--lives", trial.lives, "number of drives").range(1, 1000000);
  table.add("--seed", trial.seed, "seed of all random draws");
  table.add("--every", trial.every, "hours of use between two assessments").range(1e-3, 1e9);
}

const Subcommand TRIALS{ Subject::STUDY, "life trials",
                         "lives of drives whose parameters are drawn at random, with forecasts of the remaining life",
                         declareTrials, trials };
}  // namespace
}  // namespace hjt
