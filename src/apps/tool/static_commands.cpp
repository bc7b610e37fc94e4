// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/common/configuration.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/common/not_converged.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/progress.hpp"
#include "apps/common/text_table.hpp"
#include "apps/common/validators.hpp"
#include "apps/tool/commands.hpp"

#include "harmonic_joint_twin/statics/static_analysis.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

/// One quantity of every tooth: its name in files and documents, its place in the table.
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
                                             { "mesh_force", &ToothTable::mesh_force } };
/// Only where there is a circular spline.
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

/// One line a tooth, each begun with `leading`.
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

/// Warns of a gear whose teeth press against each other without load.
void warnIfJammed(const Parameters& parameters)
{
  const FitCheck fit = checkFit(parameters);
  if (fit.jams())
  {
    std::cerr << "joint_twin: warning: the teeth jam without load: " << fit.teeth_loaded << " of "
              << parameters.gear.teeth_flexspline << " loaded, " << shortNumber(fit.wave_generator_force)
              << " N on the wave generator, " << shortNumber(fit.wave_generator_force_insertion)
              << " N without the circular spline; compare gear.wave_amplitude, gear.rim_thickness, "
                 "gear.tooth_height_flexspline, gear.tip_radius_circular_spline, mesh.flank_clearance and the numbers "
                 "of teeth\n";
  }
}

struct InsertOptions : CommonOptions
{
  std::string csv;
};

int insert(const InsertOptions& options)
{
  const Parameters parameters = loadParameters(options);
  if (!options.csv.empty())
  {
    requireWritable(options.csv, options.force);
  }
  warnIfJammed(parameters);
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
  if (options.json)
  {
    const Json json{ { "wave_generator_force_max", result.wave_generator_force_max },
                     { "wave_generator_force_min", result.wave_generator_force_min },
                     { "wave_generator_force_sum", result.wave_generator_force_sum },
                     { "teeth_in_contact", result.teeth_in_contact },
                     { "tension_min", result.tension_min },
                     { "tension_max", result.tension_max },
                     { "radius_major_axis", result.radius_major_axis },
                     { "radius_minor_axis", result.radius_minor_axis },
                     { "bending_force_max", result.bending_force_max },
                     { "residual", result.status.residual },
                     { "iterations", result.status.iterations },
                     { "solve_time", result.solve_time } };
    std::cout << json.dump(2) << '\n';
    return EXIT_DONE;
  }
  printValues({ { "wave generator force, largest", shortNumber(result.wave_generator_force_max), "N" },
                { "wave generator force, smallest", shortNumber(result.wave_generator_force_min), "N" },
                { "wave generator force, sum", shortNumber(result.wave_generator_force_sum), "N" },
                { "teeth in contact", std::to_string(result.teeth_in_contact), "" },
                { "rim tension, smallest", shortNumber(result.tension_min), "N" },
                { "rim tension, largest", shortNumber(result.tension_max), "N" },
                { "radius at the major axis", shortNumber(result.radius_major_axis), "m" },
                { "radius at the minor axis", shortNumber(result.radius_minor_axis), "m" },
                { "bending force, largest", shortNumber(result.bending_force_max), "N" },
                { "residual", shortNumber(result.status.residual), "N" },
                { "iterations", std::to_string(result.status.iterations), "" },
                { "solve time", shortNumber(result.solve_time), "s" } });
  return EXIT_DONE;
}

struct StiffnessOptions : CommonOptions
{
  std::vector<double> torques;
  double angle{};
  std::string csv;
  bool teeth{};
};

Json teethJson(const ToothTable& teeth)
{
  Json json;
  for (const ToothColumn& column : meshColumns())
  {
    json[column.name] = teeth.*column.values;
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

int stiffness(const StiffnessOptions& options)
{
  const Parameters parameters = loadParameters(options);
  if (!options.csv.empty())
  {
    requireWritable(options.csv, options.force);
  }
  warnIfJammed(parameters);
  const auto rows = analyseStiffness(parameters, options.angle, options.torques);
  Json json_rows = Json::array();
  std::vector<std::vector<double>> table;
  for (const StiffnessRow& row : rows)
  {
    if (!row.status.ok())
    {
      return notConverged("the row of torque " + shortNumber(row.torque) + " N.m", row.status);
    }
    json_rows.push_back({ { "torque", row.torque },
                          { "output_angle", row.output_angle },
                          { "wave_generator_torque", row.wave_generator_torque },
                          { "housing_torque", row.housing_torque },
                          { "cup_rotation", row.cup_rotation },
                          { "teeth_loaded", row.teeth_loaded },
                          { "mesh_force_max", row.mesh_force_max },
                          { "wave_generator_force_sum", row.wave_generator_force_sum },
                          { "residual", row.status.residual } });
    if (options.teeth)
    {
      json_rows.back()["teeth"] = teethJson(row.teeth);
    }
    table.push_back({ row.torque, row.output_angle, row.wave_generator_torque, static_cast<double>(row.teeth_loaded),
                      row.mesh_force_max, row.wave_generator_force_sum, row.status.residual });
  }
  if (!options.csv.empty())
  {
    writeTeeth(options.csv, rows);
  }
  if (options.json)
  {
    std::cout << Json{ { "wave_generator_angle", options.angle }, { "rows", json_rows } }.dump(2) << '\n';
    return EXIT_DONE;
  }
  printTable({ "torque [N.m]", "output angle [rad]", "WG torque [N.m]", "teeth loaded [-]", "mesh force max [N]",
               "WG force sum [N]", "residual [N]" },
             table);
  return EXIT_DONE;
}

struct TurnOptions : CommonOptions
{
  double load{};
  double angle_range{};
  int steps{};
};

int turn(const TurnOptions& options)
{
  const Parameters parameters = loadParameters(options);
  std::vector<TurnRow> rows;
  {
    Progress progress("turning");
    rows = analyseTurn(parameters, options.load, options.angle_range, options.steps,
                       [&](int step) { progress.update(static_cast<double>(step) / options.steps); });
  }
  Json json_rows = Json::array();
  std::vector<std::vector<double>> table;
  for (const TurnRow& row : rows)
  {
    if (!row.status.ok())
    {
      return notConverged("the row of wave generator angle " + shortNumber(row.wave_generator_angle) + " rad",
                          row.status);
    }
    json_rows.push_back({ { "wave_generator_angle", row.wave_generator_angle },
                          { "output_angle", row.output_angle },
                          { "kinematic_error", row.kinematic_error },
                          { "wave_generator_torque", row.wave_generator_torque },
                          { "housing_torque", row.housing_torque } });
    table.push_back({ row.wave_generator_angle, row.output_angle, row.kinematic_error, row.wave_generator_torque });
  }
  if (options.json)
  {
    std::cout << Json{ { "load", options.load }, { "rows", json_rows } }.dump(2) << '\n';
    return EXIT_DONE;
  }
  printTable({ "WG angle [rad]", "output angle [rad]", "kinematic error [rad]", "WG torque [N.m]" }, table);
  return EXIT_DONE;
}
}  // namespace

void addInsertCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<InsertOptions>();
  auto* command = app.add_subcommand("insert",
                                     "static equilibrium after the wave generator's insertion, circular spline "
                                     "left out");
  command->add_option("--csv", options->csv, "write positions and forces of every tooth")->type_name("FILE");
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = insert(*options); });
}

void addStiffnessCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<StiffnessOptions>();
  auto* command = app.add_subcommand("stiffness", "torsion under load, wave generator locked");
  command->add_option("--torques", options->torques, "loads on the circular spline, e.g. 5,14,48 [N.m]")
      ->required()
      ->delimiter(',')
      ->check(FINITE);
  command->add_option("--angle", options->angle, "wave generator angle [rad]")->check(FINITE);
  command->add_option("--csv", options->csv, "write positions and forces of every tooth at every torque")
      ->type_name("FILE");
  addCommonOptions(*command, *options);
  command
      ->add_flag(
          "--teeth", options->teeth,
          "every tooth's forces [N], place in its space [m], tilt [rad] and gap to the nearer flank [m]; with --json")
      ->needs("--json");
  command->callback([options, &exit_code] { exit_code = stiffness(*options); });
}

void addTurnCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<TurnOptions>();
  auto* command = app.add_subcommand("turn", "quasi-static turning at constant load, friction left out");
  command->add_option("--load", options->load, "load on the circular spline [N.m]")->required()->check(FINITE);
  command->add_option("--angle-range", options->angle_range, "wave generator turns from 0 to this [rad]")
      ->required()
      ->check(FINITE);
  command->add_option("--steps", options->steps, "steps of equal size")->required()->check(CLI::Range(1, 100000000));
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = turn(*options); });
}
}  // namespace hjt
