// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <iostream>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "apps/common/configuration.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/process_end.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "statics/inertia_error.hpp"
#include "studies/dynamic_runs.hpp"
#include "studies/ratchet_analysis.hpp"

namespace hjt
{
namespace
{
const std::map<std::string, RingMethod> METHODS{ { "rk4", RingMethod::RUNGE_KUTTA4 },
                                                 { "implicit_euler", RingMethod::IMPLICIT_EULER },
                                                 { "tr_bdf2", RingMethod::TR_BDF2 },
                                                 { "esdirk4", RingMethod::ESDIRK4 } };

int stopped(double time)
{
  std::cerr << "joint_twin: the integration of the ring failed at " << time
            << " s; a shorter --step may help (for rk4 less than 2.8 / angular frequency of the stiffest mode)\n";
  return EXIT_FAILED;
}

void requireEstimate(const std::string& method, double tolerance)
{
  if (tolerance > 0.0 && !judgesItsError(METHODS.at(method)))
  {
    throw InputError("--tolerance " + shortNumber(tolerance) + " [m]: " + method +
                     " has no error estimate; tr_bdf2 and esdirk4 have one");
  }
}

void declareMethod(OptionTable& table, std::string& method, double& step, double& tolerance)
{
  std::vector<std::string> names;
  for (const auto& [name, known] : METHODS)
  {
    names.push_back(name);
  }
  table
      .add("--method", method,
           "rk4: explicit of order 4 (Boost.odeint); implicit_euler, tr_bdf2, esdirk4: implicit of order 1, 2, 4")
      .choice(names);
  table.add("--step", step, "time step [s]").positive();
  table
      .add("--tolerance", tolerance,
           "largest error of a tooth's position in one step [m]; the step length follows from this error and is at "
           "most --step")
      .positive();
}

struct TransientOptions : CommonOptions
{
  std::string method{ "esdirk4" };
  TransientSetup setup;
  std::string csv;
};

const std::vector<Column<TransientRow>> TRANSIENT_COLUMNS{ { "time", &TransientRow::time },
                                                           { "force_max", &TransientRow::force_max },
                                                           { "force_lowest", &TransientRow::force_lowest },
                                                           { "force_highest", &TransientRow::force_highest },
                                                           { "radius_major_axis", &TransientRow::radius_major_axis },
                                                           { "stored_energy", &TransientRow::stored },
                                                           { "kinetic_energy", &TransientRow::kinetic },
                                                           { "supplied_energy", &TransientRow::supplied },
                                                           { "dissipated_energy", &TransientRow::dissipated } };

int transient(const TransientOptions& options)
{
  const Parameters parameters = loadParameters(options);
  TransientSetup setup = options.setup;
  setup.method = METHODS.at(options.method);
  requireEstimate(options.method, setup.tolerance);
  if (setup.window_start >= setup.duration)
  {
    throw InputError("--window " + shortNumber(setup.window_start) + " [s] must be before the end, --duration " +
                     shortNumber(setup.duration) + " [s]");
  }
  requireWritable(options.csv, options.force);
  const TransientResult result = analyseTransient(parameters, setup, showProgress("inserting"));
  if (!result.finished)
  {
    return stopped(result.stopped_at);
  }
  writeTable(options.csv, TRANSIENT_COLUMNS, result.rows);
  const TransientRow& end = result.rows.back();
  const double numerical = end.supplied - end.dissipated - end.stored - end.kinetic;
  printReport(options.json,
              { { "method", "", options.method },
                { "step", "", setup.step },
                { "tolerance", "", setup.tolerance },
                { "window_start", "", setup.window_start },
                { "force_max_lowest", "largest force on a tooth, lowest in the window", result.window_lowest, "N" },
                { "force_max_highest", "largest force on a tooth, highest in the window", result.window_highest, "N" },
                { "force_max_mean", "largest force on a tooth, mean over the window", result.window_mean, "N" },
                { "energy_supplied", "energy supplied", end.supplied, "J" },
                { "energy_stored", "energy stored", end.stored, "J" },
                { "energy_kinetic", "energy kinetic", end.kinetic, "J" },
                { "energy_dissipated", "energy dissipated by dashpots", end.dissipated, "J" },
                { "energy_lost", "energy lost by the integration and the contact law", numerical, "J" },
                { "steps", "steps", result.counts.steps },
                { "force_evaluations", "force evaluations", result.counts.force_evaluations },
                { "factorisations", "factorisations", result.counts.factorisations },
                { "halvings", "steps halved", result.counts.halvings },
                { "rejections", "steps rejected", result.counts.rejections },
                { "solve_time", "solve time", result.solve_time, "s" },
                { "series", "", Table(TRANSIENT_COLUMNS, result.rows).columns() },
                { "tooth_x", "", result.tooth_x },
                { "tooth_y", "", result.tooth_y } });
  return EXIT_DONE;
}

void declareTransient(OptionTable& table, TransientOptions& options)
{
  TransientSetup& setup = options.setup;
  declareMethod(table, options.method, setup.step, setup.tolerance);
  table.add("--duration", setup.duration, "simulated time [s]").positive();
  table
      .add("--window", setup.window_start,
           "beginning of the window for statistics of the largest force; the window lasts to the end [s]")
      .positive();
  table.add("--sample", setup.sample_period, "time between two rows of the series [s]").positive();
  table.add("--csv", options.csv, "file for the series").type("FILE");
  addCommonOptions(table, options);
}

const Subcommand TRANSIENT{ Subject::STUDY, "transient",
                            "insertion of the wave generator with a mass at every tooth: the wave amplitude grows at "
                            "a constant speed and then stays constant; without circular spline",
                            declareTransient, transient };

struct DynamicsOptions : CommonOptions
{
  std::string method{ "tr_bdf2" };
  QuasiStaticSetup setup;
};

const std::vector<Column<QuasiStaticRow>> DYNAMICS_COLUMNS{
  { "time", &QuasiStaticRow::time },
  { "torsion", &QuasiStaticRow::torsion_dynamic },
  { "torsion_quasi_static", &QuasiStaticRow::torsion_quasi_static },
  { "wave_generator_torque", &QuasiStaticRow::wave_generator_torque_dynamic },
  { "wave_generator_torque_quasi_static", &QuasiStaticRow::wave_generator_torque_quasi_static },
  { "contact_error_rms", &QuasiStaticRow::contact_error_rms },
  { "mesh_error_rms", &QuasiStaticRow::mesh_error_rms }
};

struct ComparedQuantity
{
  std::string name;
  DynamicError QuasiStaticResult::*error;
  const char* unit;
};
const std::array<ComparedQuantity, 6> COMPARED{ { { "contact_force", &QuasiStaticResult::contact_force, "N" },
                                                  { "mesh_force", &QuasiStaticResult::mesh_force, "N" },
                                                  { "position", &QuasiStaticResult::position, "m" },
                                                  { "wave_generator_torque", &QuasiStaticResult::wave_generator_torque,
                                                    "N.m" },
                                                  { "output_torque", &QuasiStaticResult::output_torque, "N.m" },
                                                  { "torsion", &QuasiStaticResult::torsion, "rad" } } };

int dynamics(const DynamicsOptions& options)
{
  const Parameters parameters = loadParameters(options);
  QuasiStaticSetup setup = options.setup;
  setup.method = METHODS.at(options.method);
  requireEstimate(options.method, setup.tolerance);
  const QuasiStaticResult result = checkQuasiStatic(parameters, setup, showProgress("turning"));
  if (result.outcome == QuasiStaticOutcome::NO_EQUILIBRIUM)
  {
    return notConverged("the comparison at " + shortNumber(result.stopped_at) + " s", result.status);
  }
  if (result.outcome == QuasiStaticOutcome::STEP_FAILED)
  {
    return stopped(result.stopped_at);
  }
  std::vector<ReportLine> lines{ { "speed", "", setup.speed },
                                 { "load", "", setup.load },
                                 { "mass", "", parameters.ring.mass } };
  for (const auto& [name, member, unit] : COMPARED)
  {
    const DynamicError& error = result.*member;
    lines.push_back({ name + ".size", name + ", quasi-static rms", error.size, unit });
    lines.push_back({ name + ".error_rms", name + ", error rms", error.rms, unit });
    lines.push_back({ name + ".error_max", name + ", error max", error.max, unit });
    lines.push_back({ name + ".relative_rms", "", error.rms / error.size });
    lines.push_back({ name + ".relative_max", "", error.max / error.size });
  }
  lines.push_back({ "expected_mesh_force_error", "mesh_force, error expected from speed and load",
                    expectedMeshForceError(parameters.ring, parameters.gear, setup.speed, setup.load), "N" });
  lines.insert(lines.end(), { { "force_evaluations", "", result.force_evaluations },
                              { "solve_time", "solve time", result.solve_time, "s" },
                              { "series", "", Table(DYNAMICS_COLUMNS, result.rows).columns() },
                              { "teeth.time", "", result.last.time },
                              { "teeth.contact_force", "", result.last.contact_dynamic },
                              { "teeth.contact_force_quasi_static", "", result.last.contact_quasi_static },
                              { "teeth.mesh_force", "", result.last.mesh_dynamic },
                              { "teeth.mesh_force_quasi_static", "", result.last.mesh_quasi_static } });
  printReport(options.json, lines);
  return EXIT_DONE;
}

void declareDynamics(OptionTable& table, DynamicsOptions& options)
{
  QuasiStaticSetup& setup = options.setup;
  table.add("--speed", setup.speed, "speed of the wave generator [rad/s]");
  table.add("--load", setup.load, "load on the circular spline [N.m]");
  declareMethod(table, options.method, setup.step, setup.tolerance);
  table.add("--settle", setup.settle_time, "time before the first comparison [s]").range(0.0, 1e9);
  table.add("--duration", setup.duration, "duration of the comparison [s]").positive();
  table.add("--every", setup.compare_period, "time between two comparisons [s]").positive();
  addCommonOptions(table, options);
}

const Subcommand DYNAMICS{
  Subject::STUDY, "dynamics",
  "turning with a mass at every tooth, compared with the ring in equilibrium. Speed of the wave generator and load are "
  "constant. There is no dry friction",
  declareDynamics, dynamics
};

struct RatchetOptions : CommonOptions
{
  double angle{};
  double lobe_stiffness{ std::numeric_limits<double>::infinity() };
  double angle_step{ 2e-4 };
  double torque_limit{ 2000.0 };
};

const char* endOf(RatchetEnd end)
{
  return end == RatchetEnd::LIMIT_REACHED ? "limit reached" :
         end == RatchetEnd::TEETH_JUMPED  ? "teeth jumped" :
                                            "gave up, no equilibrium";
}

const std::vector<Column<RatchetRow>> RATCHET_COLUMNS{ { "output_angle", &RatchetRow::output_angle },
                                                       { "torque", &RatchetRow::torque },
                                                       { "wave_amplitude", &RatchetRow::wave_amplitude },
                                                       { "lobe_force", &RatchetRow::lobe_force },
                                                       { "depth_max", &RatchetRow::depth_max },
                                                       { "mesh_force_max", &RatchetRow::mesh_force_max },
                                                       { "wave_generator_force_max",
                                                         &RatchetRow::wave_generator_force_max },
                                                       { "teeth_loaded", &RatchetRow::teeth_loaded },
                                                       { "snaps", &RatchetRow::snaps },
                                                       { "teeth_jumped", &RatchetRow::teeth_jumped } };

int ratchet(const RatchetOptions& options)
{
  const RatchetResult result =
      analyseRatchet(loadAnalysed(options, Analysis::RING), options.angle, options.lobe_stiffness, options.angle_step,
                     options.torque_limit, showProgress("loading"));
  if (!result.status.ok())
  {
    return notConverged("no load", result.status);
  }
  const RatchetRow& peak = result.peak;
  printReport(options.json, { { "end", "end", endOf(result.end) },
                              { "peak.torque", "largest torque", peak.torque, "N.m" },
                              { "peak.output_angle", "output angle at the largest torque", peak.output_angle, "rad" },
                              { "peak.wave_amplitude", "wave amplitude that remains", peak.wave_amplitude, "m" },
                              { "peak.lobe_force", "force on each lobe", peak.lobe_force, "N" },
                              { "peak.depth_max", "deepest tooth", peak.depth_max, "m" },
                              { "peak.mesh_force_max", "mesh force, largest", peak.mesh_force_max, "N" },
                              { "peak.wave_generator_force_max", "wave generator force, largest",
                                peak.wave_generator_force_max, "N" },
                              { "peak.snaps", "snaps of the teeth before the largest torque", peak.snaps },
                              { "peak.teeth_jumped", "teeth jumped", peak.teeth_jumped },
                              { "peak.teeth_loaded", "teeth loaded", peak.teeth_loaded },
                              { "rows", "", Table(RATCHET_COLUMNS, result.rows).rows() } });
  if (result.end == RatchetEnd::NO_EQUILIBRIUM)
  {
    std::cerr << "joint_twin: the search ended, because the ring has no equilibrium one step of "
              << shortNumber(options.angle_step) << " rad beyond "
              << shortNumber(result.rows.empty() ? 0.0 : result.rows.back().output_angle)
              << " rad; the torque has not decreased, so its largest value is a lower bound of the jump's torque\n";
    return EXIT_FAILED;
  }
  return EXIT_DONE;
}

void declare(OptionTable& table, RatchetOptions& options)
{
  table
      .add("--lobe-stiffness", options.lobe_stiffness,
           "radial stiffness of each lobe with its support in plug, circular spline and housing, about 1e8 at size 25 "
           "(docs/model.md, Jump) [N/m]; default: rigid, for which the largest torque is an upper bound")
      .range(1e3, 1e15);
  table.add("--angle", options.angle, "wave generator angle [rad]");
  table.add("--angle-step", options.angle_step, "step of the output angle [rad]").range(1e-6, 1e-2);
  table.add("--torque-limit", options.torque_limit, "torque at which the search ends without a jump [N.m]")
      .range(1.0, 1e6);
  addFaultOption(table, options);
  addCommonOptions(table, options);
}

const Subcommand RATCHET{
  Subject::GEAR, "ratchet",
  "jump of the teeth: wave generator locked, output moved until the torque decreases, without friction", declare,
  ratchet
};
}  // namespace
}  // namespace hjt
