// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/common/configuration.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/common/not_converged.hpp"
#include "apps/common/progress.hpp"
#include "apps/common/text_table.hpp"
#include "apps/common/validators.hpp"
#include "apps/tool/commands.hpp"

#include "harmonic_joint_twin/statics/loss_analysis.hpp"
#include "harmonic_joint_twin/statics/torsion_loop.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

struct PitchOptions : CommonOptions
{
  int positions{ 16 };  // wave generator angles per tooth pitch
};

void addPitchOptions(CLI::App& command, PitchOptions& options)
{
  command
      .add_option("--positions", options.positions, "wave generator angles per tooth pitch that are averaged over [16]")
      ->check(CLI::Range(1, 100000));
  addCommonOptions(command, options);
}

struct LossesOptions : PitchOptions
{
  std::vector<double> speeds;
  std::vector<double> loads;
};

int losses(const LossesOptions& options)
{
  const Parameters parameters = loadParameters(options);
  std::vector<LossRow> rows;
  {
    Progress progress("turning");
    rows = analyseLosses(parameters, options.speeds, options.loads, options.positions,
                         [&](int done) { progress.update(static_cast<double>(done) / options.loads.size()); });
  }
  Json json_rows = Json::array();
  std::vector<std::vector<double>> table;
  for (const LossRow& row : rows)
  {
    if (!row.status.ok())
    {
      return notConverged("the load of " + shortNumber(row.load_torque) + " N.m", row.status);
    }
    json_rows.push_back({ { "motor_speed", row.motor_speed },
                          { "load_torque", row.load_torque },
                          { "load_reduced", row.load_reduced },
                          { "bearing", row.loss.bearing },
                          { "interface", row.loss.interface },
                          { "mesh", row.loss.mesh },
                          { "cup", row.loss.cup },
                          { "damping", row.loss.damping },
                          { "motor", row.loss.motor },
                          { "gear_loss", row.loss.gear() },
                          { "gear_efficiency", row.gear_efficiency } });
    table.push_back({ row.motor_speed, row.load_torque, row.load_reduced, row.loss.bearing, row.loss.interface,
                      row.loss.mesh, row.loss.cup, row.loss.damping, row.loss.motor, row.gear_efficiency });
  }
  if (options.json)
  {
    std::cout << Json{ { "temperature", parameters.input.temperature }, { "rows", json_rows } }.dump(2) << '\n';
    return EXIT_DONE;
  }
  printTable({ "speed [rad/s]", "load [N.m]", "reduced [N.m]", "bearing [N.m]", "interface [N.m]", "mesh [N.m]",
               "cup [N.m]", "damping [N.m]", "motor [N.m]", "gear efficiency [-]" },
             table);
  return EXIT_DONE;
}

int breakaway(const PitchOptions& options)
{
  const Parameters parameters = loadParameters(options);
  const Breakaway result = analyseBreakaway(parameters, options.positions);
  if (!result.status.ok())
  {
    return notConverged("the load that drives the gear back", result.status);
  }
  if (options.json)
  {
    std::cout << Json{
      { "temperature", parameters.input.temperature },
      { "starting_torque", result.starting },
      { "back_driving_torque", result.back_driving }
    }.dump(2) << '\n';
    return EXIT_DONE;
  }
  printValues({ { "starting torque, at the wave generator", shortNumber(result.starting), "N.m" },
                { "back-driving torque, at the output", shortNumber(result.back_driving), "N.m" } });
  return EXIT_DONE;
}

struct HysteresisOptions : CommonOptions
{
  double amplitude{};
  double lost_motion_torque{};
  int steps{ 200 };
};

int hysteresis(const HysteresisOptions& options)
{
  if (options.lost_motion_torque > options.amplitude)
  {
    std::cerr << "joint_twin: --lost-motion-torque must not exceed --amplitude [N.m]\n";
    return EXIT_USAGE;
  }
  const TorsionLoop loop =
      analyseTorsionLoop(loadParameters(options), options.amplitude, options.lost_motion_torque, options.steps);
  if (!loop.status.ok())
  {
    return notConverged("the torsion loop", loop.status);
  }
  if (options.json)
  {
    Json points = Json::array();
    for (const TorsionPoint& point : loop.points)
    {
      points.push_back({ { "torque", point.torque }, { "output_angle", point.output_angle } });
    }
    std::cout << Json{
      { "hysteresis", loop.hysteresis }, { "lost_motion", loop.lost_motion }, { "points", points }
    }.dump(2) << '\n';
    return EXIT_DONE;
  }
  printValues({ { "hysteresis, loop width at no load", shortNumber(loop.hysteresis), "rad" },
                { "lost motion", shortNumber(loop.lost_motion), "rad" } });
  return EXIT_DONE;
}
}  // namespace

void addLossesCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<LossesOptions>();
  auto* command = app.add_subcommand("losses", "friction and efficiency of steady turning, by speed and load");
  command->add_option("--speeds", options->speeds, "motor speeds, e.g. 50,209.4 [rad/s]")
      ->required()
      ->delimiter(',')
      ->check(FINITE);
  command->add_option("--loads", options->loads, "loads on the circular spline, e.g. 0,20,87 [N.m]")
      ->required()
      ->delimiter(',')
      ->check(FINITE);
  addPitchOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = losses(*options); });
}

void addBreakawayCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<PitchOptions>();
  auto* command = app.add_subcommand("breakaway", "torques at which the gear begins to move: started and driven back");
  addPitchOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = breakaway(*options); });
}

void addHysteresisCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<HysteresisOptions>();
  auto* command =
      app.add_subcommand("hysteresis", "torsion to and fro, wave generator locked, with the friction of the teeth");
  command->add_option("--amplitude", options->amplitude, "largest load [N.m]")->required()->check(CLI::PositiveNumber);
  command
      ->add_option("--lost-motion-torque", options->lost_motion_torque,
                   "lost motion is taken between plus and minus this load, e.g. 4 % of the rated one [N.m]")
      ->required()
      ->check(CLI::PositiveNumber);
  command->add_option("--steps", options->steps, "angles of one sweep [200]")->check(CLI::Range(2, 1000000));
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = hysteresis(*options); });
}
}  // namespace hjt
