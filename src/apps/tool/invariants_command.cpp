// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/common/configuration.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/common/not_converged.hpp"
#include "apps/common/progress.hpp"
#include "apps/common/text_table.hpp"
#include "apps/common/validators.hpp"
#include "apps/tool/commands.hpp"

#include "studies/energy_ledger.hpp"
#include "studies/small_wave.hpp"
#include "studies/state_invariants.hpp"
#include "studies/turned_machine.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

struct StateOptions : CommonOptions
{
  std::vector<double> loads;
  std::vector<double> steps;
  double angle{};
  int pitches{ 1 };
};

Json rowOf(const StateInvariants& state)
{
  return { { "load", state.load },
           { "wave_generator_angle", state.wave_generator_angle },
           { "output_angle", state.output_angle },
           { "energy", state.energy },
           { "residual", state.residual },
           { "softest_stiffness", state.softest_stiffness },
           { "contact_force_max", state.contact_force_max },
           { "flank_force_max", state.flank_force_max },
           { "half_turn_position", state.half_turn.position },
           { "half_turn_contact_force", state.half_turn.contact_force },
           { "half_turn_flank_force", state.half_turn.flank_force },
           { "pitch_shift_position", state.pitch_shift.position },
           { "pitch_shift_contact_force", state.pitch_shift.contact_force },
           { "pitch_shift_flank_force", state.pitch_shift.flank_force },
           { "pitch_shift_energy", state.pitch_shift_energy },
           { "wave_generator_torque", state.wave_generator_torque },
           { "output_torque", state.output_torque },
           { "cup_torque", state.cup_torque } };
}

Json rowOf(double load, const PotentialRow& row)
{
  return { { "load", load },
           { "wave_generator_step", row.wave_generator_step },
           { "output_step", row.output_step },
           { "wave_generator_torque", row.wave_generator_torque },
           { "wave_generator_difference", row.wave_generator_difference },
           { "output_torque", row.output_torque },
           { "output_difference", row.output_difference },
           { "wave_generator_by_output", row.wave_generator_by_output },
           { "output_by_wave_generator", row.output_by_wave_generator },
           { "condensed_stiffness", row.condensed_stiffness } };
}

int state(const StateOptions& options)
{
  const Parameters parameters = loadParameters(options);
  Json states = Json::array();
  Json potential = Json::array();
  std::vector<std::vector<double>> table;
  std::vector<std::vector<double>> potential_table;
  for (const double load : options.loads)
  {
    const StateInvariants invariants = analyseState(parameters, options.angle, load, options.pitches);
    if (!invariants.status.ok())
    {
      return notConverged("a load of " + shortNumber(load) + " N.m", invariants.status);
    }
    states.push_back(rowOf(invariants));
    table.push_back({ load, invariants.half_turn.position, invariants.half_turn.flank_force,
                      invariants.pitch_shift.position, invariants.pitch_shift.flank_force,
                      invariants.wave_generator_torque + invariants.output_torque + invariants.cup_torque,
                      invariants.residual });
    for (const PotentialRow& row : analysePotential(parameters, options.angle, load, options.steps))
    {
      if (!row.status.ok())
      {
        return notConverged("a step of " + shortNumber(row.wave_generator_step) + " rad", row.status);
      }
      potential.push_back(rowOf(load, row));
      potential_table.push_back({ load, row.wave_generator_step, row.wave_generator_difference, row.output_difference,
                                  row.wave_generator_by_output, row.output_by_wave_generator });
    }
  }
  if (options.json)
  {
    const Json document{ { "pitches", options.pitches }, { "states", states }, { "potential", potential } };
    std::cout << document.dump(2) << '\n';
    return EXIT_DONE;
  }
  printTable({ "load [N.m]", "half turn [m]", "half turn [N]", "pitch shift [m]", "pitch shift [N]", "torque sum [N.m]",
               "residual [N]" },
             table);
  if (!potential_table.empty())
  {
    std::cout << '\n';
    printTable({ "load [N.m]", "WG step [rad]", "T + dU/d(WG) [N.m]", "T + dU/d(output) [N.m]",
                 "dT(WG)/d(output) [N.m/rad]", "dT(output)/d(WG) [N.m/rad]" },
               potential_table);
  }
  return EXIT_DONE;
}

struct FrameOptions : CommonOptions
{
  double load{};
  unsigned seed{ 1 };
  int samples{ 41 };
};

int frame(const FrameOptions& options)
{
  const TurnedMachine result =
      analyseTurnedMachine(loadParameters(options), options.load, options.seed, options.samples);
  if (!result.status.ok())
  {
    return notConverged("a load of " + shortNumber(options.load) + " N.m", result.status);
  }
  Json elements = Json::array();
  std::vector<NamedValue> changes;
  for (const TurnedElement& element : result.elements)
  {
    elements.push_back({ { "name", element.name },
                         { "force_max", element.force_max },
                         { "force_difference", element.force_difference },
                         { "energy", element.energy },
                         { "energy_difference", element.energy_difference },
                         { "torque_difference", element.torque_difference } });
    changes.push_back({ element.name + ", largest change of a force", shortNumber(element.force_difference), "N" });
  }
  Json bending = Json::array();
  std::vector<std::vector<double>> table;
  for (const TurnedBending& row : result.bending)
  {
    bending.push_back({ { "angle", row.angle },
                        { "curvature_force", row.curvature_force },
                        { "absolute_force", row.absolute_force },
                        { "curvature_energy", row.curvature_energy },
                        { "absolute_energy", row.absolute_energy } });
    table.push_back({ row.angle, row.curvature_force, row.absolute_force });
  }
  if (options.json)
  {
    std::cout << Json{ { "load", options.load }, { "elements", elements }, { "bending", bending } }.dump(2) << '\n';
    return EXIT_DONE;
  }
  printValues(changes);
  std::cout << '\n';
  printTable({ "turn [rad]", "bending, law curvature [N]", "bending, law absolute [N]" }, table);
  return EXIT_DONE;
}

struct SmallWaveOptions : CommonOptions
{
  double smallest{};
  int count{};
  bool hold{};
};

Json jsonOf(const ShapeError& error)
{
  return { { "radial", error.radial }, { "tangential", error.tangential }, { "tilt", error.tilt } };
}

int smallWave(const SmallWaveOptions& options)
{
  Json rows = Json::array();
  std::vector<std::vector<double>> table;
  const WaveBending bending = options.hold ? WaveBending::PROPORTIONAL : WaveBending::KEPT;
  for (const SmallWaveRow& row : analyseSmallWave(loadParameters(options), bending, options.smallest, options.count))
  {
    if (!row.status.ok())
    {
      return notConverged("a wave amplitude of " + shortNumber(row.wave_amplitude) + " m", row.status);
    }
    rows.push_back({ { "wave_amplitude", row.wave_amplitude },
                     { "teeth_in_contact", row.teeth_in_contact },
                     { "residual", row.status.residual },
                     { "contact_force_min", row.contact_force_min },
                     { "contact_force_max", row.contact_force_max },
                     { "thin_ring", jsonOf(row.thin_ring) },
                     { "linear", jsonOf(row.linear) },
                     { "second_order", jsonOf(row.second_order) } });
    table.push_back({ row.wave_amplitude, static_cast<double>(row.teeth_in_contact), row.thin_ring.radial,
                      row.thin_ring.tangential, row.thin_ring.tilt, row.second_order.radial,
                      row.second_order.tangential, row.second_order.tilt });
  }
  if (options.json)
  {
    std::cout << Json{ { "rows", rows } }.dump(2) << '\n';
    return EXIT_DONE;
  }
  printTable({ "wave amplitude [m]", "teeth in contact [-]", "radial [-]", "tangential [-]", "tilt [-]",
               "radial, 2nd order [-]", "tangential, 2nd order [-]", "tilt, 2nd order [-]" },
             table);
  return EXIT_DONE;
}

struct EnergyOptions : CommonOptions
{
  std::vector<double> rates;
  unsigned seed{ 1 };
  double load{ 150.0 };
  double duration{ 1.0 };
};

int energy(const EnergyOptions& options)
{
  Parameters parameters = loadParameters(options);
  const std::vector<double> rates =
      options.rates.empty() ? std::vector<double>{ parameters.solver.rate } : options.rates;
  Json rows = Json::array();
  std::vector<std::vector<double>> table;
  for (const double rate : rates)
  {
    parameters.solver.rate = rate;
    Progress progress("random motion at " + shortNumber(rate) + " Hz");
    const LedgerResult result = runLedger(parameters, { options.seed, options.load, true }, options.duration,
                                          [&](double done) { progress.update(done); });
    if (!result.status.ok())
    {
      return notConverged("a step at " + shortNumber(rate) + " Hz", result.status);
    }
    rows.push_back({ { "rate", rate },
                     { "throughput", result.throughput },
                     { "residual", result.residual },
                     { "relative_residual", result.residual / result.throughput },
                     { "travel", result.travel },
                     { "top_speed", result.top_speed },
                     { "reversals", result.reversals } });
    table.push_back(
        { rate, result.throughput, result.residual, result.residual / result.throughput, result.top_speed });
  }
  if (options.json)
  {
    std::cout << Json{ { "seed", options.seed }, { "duration", options.duration }, { "rows", rows } }.dump(2) << '\n';
    return EXIT_DONE;
  }
  printTable({ "rate [Hz]", "through [J]", "left over [J]", "left over / through [-]", "top speed [rad/s]" }, table);
  return EXIT_DONE;
}

void addStateCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<StateOptions>();
  auto* command = app.add_subcommand("state",
                                     "two-fold symmetry, shift by tooth pitches, balance of torques and "
                                     "torques as derivatives of the energy, at rest under load");
  command->add_option("--loads", options->loads, "loads on the circular spline, e.g. 0,20,150 [N.m]")
      ->required()
      ->delimiter(',')
      ->check(FINITE);
  command->add_option("--angle", options->angle, "wave generator angle [rad]")->check(FINITE);
  command->add_option("--pitches", options->pitches, "tooth pitches of the shift [-]")
      ->capture_default_str()
      ->check(CLI::Range(-10000, 10000));
  command->add_option("--steps", options->steps, "wave generator's steps for the derivatives, e.g. 1e-4,1e-5 [rad]")
      ->delimiter(',')
      ->check(CLI::Range(1e-9, 0.1));
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = state(*options); });
}

void addFrameCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<FrameOptions>();
  auto* command = app.add_subcommand("frame", "forces and energies of each element with the whole machine turned");
  command->add_option("--load", options->load, "load on the circular spline [N.m]")->check(FINITE);
  command->add_option("--seed", options->seed, "of the random angles [-]")->capture_default_str();
  command->add_option("--samples", options->samples, "angles [-]")->capture_default_str()->check(CLI::Range(1, 100000));
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = frame(*options); });
}

void addSmallWaveCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<SmallWaveOptions>();
  auto* command = app.add_subcommand("small-wave",
                                     "shape of the inserted ring against thin-ring theory, from the "
                                     "gear's wave amplitude down");
  command->add_option("--smallest", options->smallest, "smallest wave amplitude [m]")
      ->required()
      ->check(CLI::Range(1e-9, 0.01));
  command->add_option("--count", options->count, "amplitudes in equal ratios [-]")
      ->required()
      ->check(CLI::Range(1, 100000));
  command->add_flag("--hold", options->hold,
                    "bending stiffness in proportion to the amplitude: the ring touches all "
                    "round at any amplitude");
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = smallWave(*options); });
}

void addEnergyCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<EnergyOptions>();
  auto* command = app.add_subcommand("energy", "energy ledger over a random motion with reversals, load and brake");
  command->add_option("--rates", options->rates, "step rates, e.g. 10000,50000 [Hz]; default: solver.rate")
      ->delimiter(',')
      ->check(CLI::Range(100.0, 1e6));
  command->add_option("--seed", options->seed, "of the random torques [-]")->capture_default_str();
  command->add_option("--load", options->load, "largest load, either way [N.m]")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber)
      ->check(FINITE);
  command->add_option("--duration", options->duration, "simulated time [s]")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 1e4));
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = energy(*options); });
}
}  // namespace

void addInvariantsCommand(CLI::App& app, int& exit_code)
{
  auto* command = app.add_subcommand("invariants", "what must hold whatever the parameters, as numbers");
  command->require_subcommand(1);
  addStateCommand(*command, exit_code);
  addFrameCommand(*command, exit_code);
  addSmallWaveCommand(*command, exit_code);
  addEnergyCommand(*command, exit_code);
}
}  // namespace hjt
