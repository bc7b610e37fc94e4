// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <string>
#include <vector>

#include "apps/common/configuration.hpp"
#include "harmonic_joint_twin/statics/loss_analysis.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "harmonic_joint_twin/statics/torsion_loop.hpp"
#include "output/process_end.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "statics/flexspline_stress.hpp"

namespace hjt
{
namespace
{
/// A quantity of every tooth: its name in files and documents, and its member of the table.
struct ToothColumn
{
  const char* name;
  std::vector<double> ToothTable::*values;
};
const std::vector<ToothColumn> RING_COLUMNS{ { "tooth_x", &ToothTable::tooth_x },
                                             { "tooth_y", &ToothTable::tooth_y },
                                             { "radius", &ToothTable::radius },
                                             { "angle_deviation", &ToothTable::angle_deviation },
                                             { "wave_generator_force", &ToothTable::wave_generator_force },
                                             { "rim_tension", &ToothTable::rim_tension },
                                             { "bending_force", &ToothTable::bending_force },
                                             { "mesh_force", &ToothTable::mesh_force },
                                             { "stress_tooth_space", &ToothTable::stress_tooth_space },
                                             { "stress_transition", &ToothTable::stress_transition },
                                             { "stress_flange", &ToothTable::stress_flange } };
/// Quantities of a tooth that exist only in an equilibrium with circular spline.
const std::vector<ToothColumn> SPACE_COLUMNS{ { "across", &ToothTable::across },
                                              { "depth", &ToothTable::depth },
                                              { "tilt", &ToothTable::tilt },
                                              { "gap", &ToothTable::gap } };

std::vector<ToothColumn> meshColumns()
{
  std::vector<ToothColumn> columns = RING_COLUMNS;
  columns.insert(columns.end(), SPACE_COLUMNS.begin(), SPACE_COLUMNS.end());
  return columns;
}

std::vector<std::string> headings(std::vector<std::string> leading, const std::vector<ToothColumn>& columns)
{
  leading.emplace_back("tooth");
  for (const ToothColumn& column : columns)
  {
    leading.emplace_back(column.name);
  }
  return leading;
}

/// Writes one line for each tooth. Each line begins with the values `leading`.
void writeTeeth(CsvWriter& csv, const std::vector<double>& leading, const ToothTable& teeth,
                const std::vector<ToothColumn>& columns)
{
  for (std::size_t i = 0; i < teeth.radius.size(); ++i)
  {
    std::vector<double> values = leading;
    values.push_back(static_cast<double>(i));
    for (const ToothColumn& column : columns)
    {
      values.push_back((teeth.*column.values)[i]);
    }
    csv.writeRow(values);
  }
}

struct InsertOptions : CommonOptions
{
  std::string csv;
};

int insert(const InsertOptions& options)
{
  const Parameters parameters = loadAnalysed(options, Analysis::INSERTION);
  requireWritable(options.csv, options.force);
  const InsertionResult result = analyseInsertion(parameters);
  if (!result.status.ok())
  {
    return notConverged("the insertion", result.status);
  }
  if (!options.csv.empty())
  {
    CsvWriter csv(options.csv, headings({}, RING_COLUMNS));
    writeTeeth(csv, {}, result.teeth, RING_COLUMNS);
    csv.close();
  }
  printReport(options.json,
              { { "wave_generator_force_max", "wave generator force, largest", result.wave_generator_force_max, "N" },
                { "wave_generator_force_min", "wave generator force, smallest", result.wave_generator_force_min, "N" },
                { "wave_generator_force_sum", "wave generator force, sum", result.wave_generator_force_sum, "N" },
                { "teeth_in_contact", "teeth in contact", result.teeth_in_contact },
                { "tension_min", "rim tension, smallest", result.tension_min, "N" },
                { "tension_max", "rim tension, largest", result.tension_max, "N" },
                { "radius_major_axis", "radius at the major axis", result.radius_major_axis, "m" },
                { "radius_minor_axis", "radius at the minor axis", result.radius_minor_axis, "m" },
                { "bending_force_max", "bending force, largest", result.bending_force_max, "N" },
                { "residual", "residual", result.status.residual, "N" },
                { "iterations", "iterations", result.status.iterations },
                { "solve_time", "solve time", result.solve_time, "s" } });
  return EXIT_DONE;
}

void declareInsert(OptionTable& table, InsertOptions& options)
{
  table.add("--csv", options.csv, "file for positions and forces of every tooth").type("FILE");
  addFaultOption(table, options);
  addCommonOptions(table, options);
}

const Subcommand INSERT{ Subject::GEAR, "insert",
                         "static equilibrium after the wave generator's insertion, without circular spline",
                         declareInsert, insert };

struct StiffnessOptions : CommonOptions
{
  std::vector<double> torques;
  double angle{};
  std::string csv;
  bool teeth{};
};

const std::vector<Column<StiffnessRow>> STIFFNESS_COLUMNS{
  { "torque", &StiffnessRow::torque, "torque [N.m]" },
  { "output_angle", &StiffnessRow::output_angle, "output angle [rad]" },
  { "wave_generator_torque", &StiffnessRow::wave_generator_torque, "WG torque [N.m]" },
  { "housing_torque", &StiffnessRow::housing_torque, "" },
  { "cup_rotation", &StiffnessRow::cup_rotation, "" },
  { "teeth_loaded", &StiffnessRow::teeth_loaded, "teeth loaded [-]" },
  { "mesh_force_max", &StiffnessRow::mesh_force_max, "mesh force max [N]" },
  { "wave_generator_force_sum", &StiffnessRow::wave_generator_force_sum, "WG force sum [N]" },
  { "residual", [](const StiffnessRow& row) { return row.status.residual; }, "residual [N]" }
};

Json teethJson(const StiffnessRow& row)
{
  Json json;
  for (const ToothColumn& column : meshColumns())
  {
    json[column.name] = row.teeth.*column.values;
  }
  return json;
}

void writeTeeth(const std::string& path, const std::vector<StiffnessRow>& rows)
{
  CsvWriter csv(path, headings({ "torque" }, meshColumns()));
  for (const StiffnessRow& row : rows)
  {
    writeTeeth(csv, { row.torque }, row.teeth, meshColumns());
  }
  csv.close();
}

/// Stresses at each StressPlace of the flexspline: nominal, and at the notch.
Json stressJson(const Parameters& parameters, const StiffnessRow& row)
{
  const FatigueLaw fatigue_law(parameters.life, parameters.stress);
  Json json;
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    const StressCycle cycle = row.stress.cycle(place);
    Json& at = json[STRESS_PLACE_NAMES[place]];
    at["lowest"] = cycle.lowest;
    at["highest"] = cycle.highest;
    at["shear"] = cycle.shear;
    at["notch"] = parameters.stress.concentration[place] * cycle.largest();
    at["endurance_share"] = fatigue_law.enduranceShare(place, cycle);
  }
  return json;
}

/// Largest stress at a notch of the flexspline [Pa].
double largestStress(const Parameters& parameters, const StiffnessRow& row)
{
  double largest = 0.0;
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    largest = std::max(largest, parameters.stress.concentration[place] * row.stress.cycle(place).largest());
  }
  return largest;
}

int stiffness(const StiffnessOptions& options)
{
  const Parameters parameters = loadAnalysed(options, Analysis::RING);
  requireWritable(options.csv, options.force);
  const auto rows = analyseStiffness(parameters, options.angle, options.torques);
  for (const StiffnessRow& row : rows)
  {
    if (!row.status.ok())
    {
      return notConverged("the row of torque " + shortNumber(row.torque) + " N.m", row.status);
    }
  }
  if (!options.csv.empty())
  {
    writeTeeth(options.csv, rows);
  }
  std::vector<Column<StiffnessRow>> columns = STIFFNESS_COLUMNS;
  columns.push_back({ "stress_max", [&](const StiffnessRow& row) { return largestStress(parameters, row); }, "" });
  columns.push_back({ "stress", [&](const StiffnessRow& row) { return stressJson(parameters, row); }, "" });
  if (parameters.contact.support == SupportKind::SINGLE_BALLS)
  {
    columns.push_back({ "ball_force", &StiffnessRow::ball_force, "" });
  }
  if (options.teeth)
  {
    columns.push_back({ "teeth", teethJson, "" });
  }
  printReport(options.json, { { "wave_generator_angle", "", options.angle } }, { { "rows", { columns, rows } } });
  return EXIT_DONE;
}

void declareStiffness(OptionTable& table, StiffnessOptions& options)
{
  table
      .add("--torques", options.torques,
           "loads on the circular spline, for example 5,14,48 [N.m]; a load > 0 resists positive motion and turns the "
           "output towards negative angles")
      .required();
  table.add("--angle", options.angle, "wave generator angle [rad]");
  table.add("--csv", options.csv, "file for positions and forces of every tooth at every torque").type("FILE");
  addFaultOption(table, options);
  addCommonOptions(table, options);
  table
      .flag("--teeth", options.teeth,
            "with --json, add every tooth's forces [N], nominal stresses [Pa], position in its space [m], tilt [rad] "
            "and gap to the nearer flank [m]")
      .needs("--json");
}

const Subcommand STIFFNESS{ Subject::GEAR, "stiffness", "torsion under load with the wave generator locked",
                            declareStiffness, stiffness };

struct TurnOptions : CommonOptions
{
  double load{};
  double angle_range{};
  int steps{};
};

const std::vector<Column<TurnRow>> TURN_COLUMNS{
  { "wave_generator_angle", &TurnRow::wave_generator_angle, "WG angle [rad]" },
  { "output_angle", &TurnRow::output_angle, "output angle [rad]" },
  { "kinematic_error", &TurnRow::kinematic_error, "kinematic error [rad]" },
  { "wave_generator_torque", &TurnRow::wave_generator_torque, "WG torque [N.m]" },
  { "housing_torque", &TurnRow::housing_torque, "" }
};

int turn(const TurnOptions& options)
{
  const std::vector<TurnRow> rows = analyseTurn(
      loadAnalysed(options, Analysis::RING), options.load, options.angle_range, options.steps,
      [&options, show = showProgress("turning")](int step) { show(static_cast<double>(step) / options.steps); });
  for (const TurnRow& row : rows)
  {
    if (!row.status.ok())
    {
      return notConverged("the row of wave generator angle " + shortNumber(row.wave_generator_angle) + " rad",
                          row.status);
    }
  }
  printReport(options.json, { { "load", "", options.load } }, { { "rows", { TURN_COLUMNS, rows } } });
  return EXIT_DONE;
}

void declareTurn(OptionTable& table, TurnOptions& options)
{
  table.add("--load", options.load, "load on the circular spline [N.m]").required();
  table.add("--angle-range", options.angle_range, "angle to which the wave generator turns from 0 [rad]").required();
  table.add("--steps", options.steps, "number of equal steps of the turn").required().range(1, 1e8);
  addFaultOption(table, options);
  addCommonOptions(table, options);
}

const Subcommand TURN{ Subject::GEAR, "turn", "quasi-static turning at constant load, without friction", declareTurn,
                       turn };

struct PitchOptions : CommonOptions
{
  int positions{ 16 };  // number of wave generator angles per tooth pitch
};

void declarePitch(OptionTable& table, PitchOptions& options)
{
  table
      .add("--positions", options.positions,
           "number of wave generator angles per tooth pitch, over which the program averages torques")
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
  table.add("--speeds", options.speeds, "motor speeds, for example 50,209.4 [rad/s]").required();
  table.add("--loads", options.loads, "loads on the circular spline, for example 0,20,87 [N.m]").required();
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
                            "torques at the wave generator, and at the output, at which the gear begins to move",
                            declarePitch, breakaway };

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
  printReport(options.json, { { "hysteresis", "hysteresis, width of the loop at zero load", loop.hysteresis, "rad" },
                              { "lost_motion", "lost motion", loop.lost_motion, "rad" },
                              { "points", "", Table(columns, loop.points).rows() } });
  return EXIT_DONE;
}

void declareHysteresis(OptionTable& table, HysteresisOptions& options)
{
  table.add("--amplitude", options.amplitude, "largest load [N.m]").required().positive();
  table
      .add("--lost-motion-torque", options.lost_motion_torque,
           "lost motion is measured between plus and minus this load, for example 4 % of the rated torque [N.m]")
      .required()
      .positive();
  table.add("--steps", options.steps, "number of angles from one end of the load cycle to the other").range(2, 1000000);
  addFaultOption(table, options);
  addCommonOptions(table, options);
}

const Subcommand HYSTERESIS{ Subject::GEAR, "hysteresis",
                             "torsion under a load that cycles, wave generator locked, with the friction of the teeth",
                             declareHysteresis, hysteresis };
}  // namespace
}  // namespace hjt
