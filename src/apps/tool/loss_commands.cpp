// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <vector>

#include "apps/common/configuration.hpp"
#include "apps/common/not_converged.hpp"
#include "output/exit_code.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "output/text_table.hpp"

#include "harmonic_joint_twin/statics/loss_analysis.hpp"
#include "harmonic_joint_twin/statics/torsion_loop.hpp"

namespace hjt
{
namespace
{
struct PitchOptions : CommonOptions
{
  int positions{ 16 };  // wave generator angles per tooth pitch
};

void declarePitch(OptionTable& table, PitchOptions& options)
{
  table.add("--positions", options.positions, "wave generator angles per tooth pitch that are averaged over")
      .range(1, 100000);
  addFaultOption(table, options);
  addCommonOptions(table, options);
}

struct LossesOptions : PitchOptions
{
  std::vector<double> speeds;
  std::vector<double> loads;
};

const std::vector<Column<LossRow>> LOSS_COLUMNS{
  { "motor_speed", &LossRow::motor_speed, "speed [rad/s]" },
  { "load_torque", &LossRow::load_torque, "load [N.m]" },
  { "load_reduced", &LossRow::load_reduced, "reduced [N.m]" },
  { "bearing", [](const LossRow& row) { return row.loss.bearing; }, "bearing [N.m]" },
  { "interface", [](const LossRow& row) { return row.loss.interface; }, "interface [N.m]" },
  { "flexing", [](const LossRow& row) { return row.loss.flexing; }, "" },
  { "mesh", [](const LossRow& row) { return row.loss.mesh; }, "mesh [N.m]" },
  { "cup", [](const LossRow& row) { return row.loss.cup; }, "cup [N.m]" },
  { "damping", [](const LossRow& row) { return row.loss.damping; }, "damping [N.m]" },
  { "output", [](const LossRow& row) { return row.loss.output; }, "" },
  { "motor", [](const LossRow& row) { return row.loss.motor; }, "motor [N.m]" },
  { "gear_loss", [](const LossRow& row) { return row.loss.gear(); }, "" },
  { "gear_efficiency", &LossRow::gear_efficiency, "gear efficiency [-]" }
};

int losses(const LossesOptions& options)
{
  const Parameters parameters = loadAnalysed(options, Analysis::WITH_FRICTION);
  const std::vector<LossRow> rows =
      analyseLosses(parameters, options.speeds, options.loads, options.positions,
                    [&options, show = showProgress("turning")](int done)
                    { show(static_cast<double>(done) / static_cast<double>(options.loads.size())); });
  for (const LossRow& row : rows)
  {
    if (!row.status.ok())
    {
      return notConverged("the load of " + shortNumber(row.load_torque) + " N.m", row.status);
    }
  }
  printReport(options.json, { { "temperature", "", parameters.input.temperature } },
              { { "rows", { LOSS_COLUMNS, rows } } });
  return EXIT_DONE;
}

void declareLosses(OptionTable& table, LossesOptions& options)
{
  table.add("--speeds", options.speeds, "motor speeds, e.g. 50,209.4 [rad/s]").required();
  table.add("--loads", options.loads, "loads on the circular spline, e.g. 0,20,87 [N.m]").required();
  declarePitch(table, options);
}

const Subcommand LOSSES{ Subject::GEAR, "losses", "friction and efficiency of steady turning, by speed and load",
                         declareLosses, losses };

int breakaway(const PitchOptions& options)
{
  const Parameters parameters = loadAnalysed(options, Analysis::WITH_FRICTION);
  const Breakaway result = analyseBreakaway(parameters, options.positions);
  if (!result.status.ok())
  {
    return notConverged("the load that drives the gear back", result.status);
  }
  printReport(options.json,
              { { "temperature", "", parameters.input.temperature },
                { "starting_torque", "starting torque, at the wave generator", result.starting, "N.m" },
                { "back_driving_torque", "back-driving torque, at the output", result.back_driving, "N.m" } });
  return EXIT_DONE;
}

const Subcommand BREAKAWAY{ Subject::GEAR, "breakaway",
                            "torques at which the gear begins to move: started and driven back", declarePitch,
                            breakaway };

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
  const TorsionLoop loop = analyseTorsionLoop(loadAnalysed(options, Analysis::WITH_FRICTION), options.amplitude,
                                              options.lost_motion_torque, options.steps);
  if (!loop.status.ok())
  {
    return notConverged("the torsion loop", loop.status);
  }
  const std::vector<Column<TorsionPoint>> columns{ { "torque", &TorsionPoint::torque, "" },
                                                   { "output_angle", &TorsionPoint::output_angle, "" } };
  printReport(options.json, { { "hysteresis", "hysteresis, loop width at no load", loop.hysteresis, "rad" },
                              { "lost_motion", "lost motion", loop.lost_motion, "rad" },
                              { "points", "", Table(columns, loop.points).rows() } });
  return EXIT_DONE;
}

void declareHysteresis(OptionTable& table, HysteresisOptions& options)
{
  table.add("--amplitude", options.amplitude, "largest load [N.m]").required().positive();
  table
      .add("--lost-motion-torque", options.lost_motion_torque,
           "lost motion is taken between plus and minus this load, e.g. 4 % of the rated one [N.m]")
      .required()
      .positive();
  table.add("--steps", options.steps, "angles of one sweep").range(2, 1000000);
  addFaultOption(table, options);
  addCommonOptions(table, options);
}

const Subcommand HYSTERESIS{ Subject::GEAR, "hysteresis",
                             "torsion to and fro, wave generator locked, with the friction of the teeth",
                             declareHysteresis, hysteresis };
}  // namespace
}  // namespace hjt
