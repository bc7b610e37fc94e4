// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <map>
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

#include "harmonic_joint_twin/base/errors.hpp"
#include "studies/quasi_static_check.hpp"
#include "studies/ring_transient.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

const std::map<std::string, RingMethod> METHODS{ { "rk4", RingMethod::RUNGE_KUTTA4 },
                                                 { "dop853", RingMethod::DORMAND_PRINCE8 },
                                                 { "implicit_euler", RingMethod::IMPLICIT_EULER },
                                                 { "tr_bdf2", RingMethod::TR_BDF2 },
                                                 { "esdirk4", RingMethod::ESDIRK4 } };

int stopped(double time)
{
  std::cerr << "joint_twin: the ring could not be marched beyond " << time
            << " s; a shorter --step may help (rk4 needs less than 2.8 over the stiffest mode's angular frequency)\n";
  return EXIT_FAILED;
}

void requireEstimate(const std::string& method, double tolerance)
{
  if (tolerance > 0.0 && !judgesItsError(METHODS.at(method)))
  {
    throw InputError("--tolerance " + shortNumber(tolerance) + " [m]: " + method +
                     " does not judge its error; dop853, tr_bdf2 and esdirk4 do");
  }
}

void addMethodOptions(CLI::App& command, std::string& method, double& step, double& tolerance)
{
  command
      .add_option("--method", method,
                  "rk4, dop853: explicit of order 4 (Boost.odeint), 8; implicit_euler, tr_bdf2, esdirk4: implicit of "
                  "order 1, 2, 4")
      ->check(CLI::IsMember(METHODS))
      ->capture_default_str();
  command.add_option("--step", step, "of time [s]")->check(FINITE)->check(CLI::PositiveNumber)->capture_default_str();
  command
      .add_option("--tolerance", tolerance,
                  "error of a tooth's position by one step [m]: the steps are chosen by it, --step is the longest")
      ->check(FINITE)
      ->check(CLI::PositiveNumber);
}

struct TransientOptions : CommonOptions
{
  std::string method{ "esdirk4" };
  TransientSetup setup{ RingMethod::ESDIRK4, 5e-6, 0.05, 5e-3, 0.03, 5e-5 };
  std::string csv;
};

const std::vector<std::string> TRANSIENT_COLUMNS{ "time",           "force_max",         "force_lowest",
                                                  "force_highest",  "radius_major_axis", "stored_energy",
                                                  "kinetic_energy", "supplied_energy",   "dissipated_energy" };

std::vector<double> valuesOf(const TransientRow& row)
{
  return { row.time,   row.force_max, row.force_lowest, row.force_highest, row.radius_major_axis,
           row.stored, row.kinetic,   row.supplied,     row.dissipated };
}

/// Rows as one array per column.
Json columnsOf(const std::vector<TransientRow>& rows)
{
  Json json;
  for (std::size_t column = 0; column < TRANSIENT_COLUMNS.size(); ++column)
  {
    Json values = Json::array();
    for (const TransientRow& row : rows)
    {
      values.push_back(valuesOf(row)[column]);
    }
    json[TRANSIENT_COLUMNS[column]] = values;
  }
  return json;
}

int transient(TransientOptions options)
{
  const Parameters parameters = loadParameters(options);
  TransientSetup& setup = options.setup;
  setup.method = METHODS.at(options.method);
  requireEstimate(options.method, setup.tolerance);
  if (setup.window_start >= setup.duration)
  {
    throw InputError("--window " + shortNumber(setup.window_start) + " [s] must lie before the end, --duration " +
                     shortNumber(setup.duration) + " [s]");
  }
  if (!options.csv.empty())
  {
    requireWritable(options.csv, options.force);
  }
  TransientResult result;
  {
    Progress progress("inserting");
    result = analyseTransient(parameters, setup, [&](double done) { progress.update(done); });
  }
  if (!result.finished)
  {
    return stopped(result.stopped_at);
  }
  if (!options.csv.empty())
  {
    CsvWriter csv(options.csv, TRANSIENT_COLUMNS);
    for (const TransientRow& row : result.rows)
    {
      csv.writeRow(valuesOf(row));
    }
    csv.close();
  }
  const TransientRow& end = result.rows.back();
  const double numerical = end.supplied - end.dissipated - end.stored - end.kinetic;
  if (options.json)
  {
    const Json json{ { "method", options.method },
                     { "step", setup.step },
                     { "tolerance", setup.tolerance },
                     { "window_start", setup.window_start },
                     { "force_max_lowest", result.window_lowest },
                     { "force_max_highest", result.window_highest },
                     { "force_max_mean", result.window_mean },
                     { "energy_supplied", end.supplied },
                     { "energy_stored", end.stored },
                     { "energy_kinetic", end.kinetic },
                     { "energy_dissipated", end.dissipated },
                     { "energy_lost", numerical },
                     { "steps", result.counts.steps },
                     { "force_evaluations", result.counts.force_evaluations },
                     { "factorisations", result.counts.factorisations },
                     { "halvings", result.counts.halvings },
                     { "rejections", result.counts.rejections },
                     { "solve_time", result.solve_time },
                     { "series", columnsOf(result.rows) },
                     { "tooth_x", result.tooth_x },
                     { "tooth_y", result.tooth_y } };
    std::cout << json.dump() << '\n';
    return EXIT_DONE;
  }
  printValues({ { "largest wave generator force, lowest", shortNumber(result.window_lowest), "N" },
                { "largest wave generator force, highest", shortNumber(result.window_highest), "N" },
                { "largest wave generator force, mean", shortNumber(result.window_mean), "N" },
                { "energy supplied", shortNumber(end.supplied), "J" },
                { "energy stored", shortNumber(end.stored), "J" },
                { "energy kinetic", shortNumber(end.kinetic), "J" },
                { "energy dissipated by dashpots", shortNumber(end.dissipated), "J" },
                { "energy lost by method and contact law", shortNumber(numerical), "J" },
                { "steps", std::to_string(result.counts.steps), "" },
                { "force evaluations", std::to_string(result.counts.force_evaluations), "" },
                { "factorisations", std::to_string(result.counts.factorisations), "" },
                { "steps halved", std::to_string(result.counts.halvings), "" },
                { "steps rejected", std::to_string(result.counts.rejections), "" },
                { "solve time", shortNumber(result.solve_time), "s" } });
  return EXIT_DONE;
}

struct DynamicsOptions : CommonOptions
{
  std::string method{ "tr_bdf2" };
  QuasiStaticSetup setup{ RingMethod::TR_BDF2, 317.0, 20.0, 2e-6, 5e-3, 5e-3, 37e-6 };
};

Json errorJson(const DynamicError& error)
{
  return { { "size", error.size },
           { "error_rms", error.rms },
           { "error_max", error.max },
           { "relative_rms", error.rms / error.size },
           { "relative_max", error.max / error.size } };
}

int dynamics(DynamicsOptions options)
{
  const Parameters parameters = loadParameters(options);
  options.setup.method = METHODS.at(options.method);
  requireEstimate(options.method, options.setup.tolerance);
  QuasiStaticResult result;
  {
    Progress progress("turning");
    result = checkQuasiStatic(parameters, options.setup, [&](double done) { progress.update(done); });
  }
  if (result.outcome == QuasiStaticOutcome::NO_EQUILIBRIUM)
  {
    return notConverged("the comparison at " + shortNumber(result.stopped_at) + " s", result.status);
  }
  if (result.outcome == QuasiStaticOutcome::STEP_FAILED)
  {
    return stopped(result.stopped_at);
  }
  const std::vector<std::pair<std::string, const DynamicError*>> errors{
    { "contact_force", &result.contact_force }, { "mesh_force", &result.mesh_force },
    { "position", &result.position },           { "wave_generator_torque", &result.wave_generator_torque },
    { "output_torque", &result.output_torque }, { "torsion", &result.torsion }
  };
  if (options.json)
  {
    Json json{ { "speed", options.setup.speed }, { "load", options.setup.load }, { "mass", parameters.ring.mass } };
    for (const auto& [name, error] : errors)
    {
      json[name] = errorJson(*error);
    }
    json["force_evaluations"] = result.force_evaluations;
    json["solve_time"] = result.solve_time;
    Json series{ { "time", Json::array() } };
    for (const QuasiStaticRow& row : result.rows)
    {
      series["time"].push_back(row.time);
      series["torsion"].push_back(row.torsion_dynamic);
      series["torsion_quasi_static"].push_back(row.torsion_quasi_static);
      series["wave_generator_torque"].push_back(row.wave_generator_torque_dynamic);
      series["wave_generator_torque_quasi_static"].push_back(row.wave_generator_torque_quasi_static);
      series["contact_error_rms"].push_back(row.contact_error_rms);
      series["mesh_error_rms"].push_back(row.mesh_error_rms);
    }
    json["series"] = series;
    json["teeth"] = { { "time", result.last.time },
                      { "contact_force", result.last.contact_dynamic },
                      { "contact_force_quasi_static", result.last.contact_quasi_static },
                      { "mesh_force", result.last.mesh_dynamic },
                      { "mesh_force_quasi_static", result.last.mesh_quasi_static } };
    std::cout << json.dump() << '\n';
    return EXIT_DONE;
  }
  const char* units[] = { "N", "N", "m", "N.m", "N.m", "rad" };
  std::vector<NamedValue> lines;
  for (std::size_t i = 0; i < errors.size(); ++i)
  {
    const DynamicError& error = *errors[i].second;
    lines.push_back({ errors[i].first + ", quasi-static rms", shortNumber(error.size), units[i] });
    lines.push_back({ errors[i].first + ", error rms", shortNumber(error.rms), units[i] });
    lines.push_back({ errors[i].first + ", error max", shortNumber(error.max), units[i] });
  }
  lines.push_back({ "solve time", shortNumber(result.solve_time), "s" });
  printValues(lines);
  return EXIT_DONE;
}
}  // namespace

void addTransientCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<TransientOptions>();
  auto* command = app.add_subcommand("transient",
                                     "insertion of the wave generator as motion, every tooth a mass: the amplitude "
                                     "grows at constant speed, then stays; circular spline left out");
  addMethodOptions(*command, options->method, options->setup.step, options->setup.tolerance);
  const auto time = [&](const char* name, double& value, const char* meaning)
  { command->add_option(name, value, meaning)->check(FINITE)->check(CLI::PositiveNumber)->capture_default_str(); };
  time("--duration", options->setup.duration, "simulated time [s]");
  time("--growth", options->setup.growth_time, "time in which the amplitude grows [s]");
  time("--window", options->setup.window_start, "from here to the end the largest force is summed up [s]");
  time("--sample", options->setup.sample_period, "time between two rows of the series [s]");
  command->add_option("--csv", options->csv, "write the series")->type_name("FILE");
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = transient(*options); });
}

void addDynamicsCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<DynamicsOptions>();
  auto* command = app.add_subcommand("dynamics",
                                     "turning with a mass at every tooth, held against the ring in equilibrium; wave "
                                     "generator at constant speed, constant load, dry friction left out");
  command->add_option("--speed", options->setup.speed, "of the wave generator [rad/s]")
      ->check(FINITE)
      ->capture_default_str();
  command->add_option("--load", options->setup.load, "on the circular spline [N.m]")
      ->check(FINITE)
      ->capture_default_str();
  addMethodOptions(*command, options->method, options->setup.step, options->setup.tolerance);
  const auto time = [&](const char* name, double& value, const char* meaning)
  { command->add_option(name, value, meaning)->check(FINITE)->check(CLI::PositiveNumber)->capture_default_str(); };
  command->add_option("--settle", options->setup.settle_time, "time before the comparison starts [s]")
      ->check(FINITE)
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  time("--duration", options->setup.duration, "time over which is compared [s]");
  time("--every", options->setup.compare_period, "time between two comparisons [s]");
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = dynamics(*options); });
}
}  // namespace hjt
