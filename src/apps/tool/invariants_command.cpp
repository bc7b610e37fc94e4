// SPDX-License-Identifier: BSD-3-Clause
#include <utility>
#include <vector>

#include "apps/common/configuration.hpp"
#include "apps/common/not_converged.hpp"
#include "output/exit_code.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "output/text_table.hpp"

#include "studies/energy_ledger.hpp"
#include "studies/small_wave.hpp"
#include "studies/state_invariants.hpp"
#include "studies/turned_machine.hpp"

namespace hjt
{
namespace
{
const Subcommand INVARIANTS{ Subject::STUDY, "invariants", "properties that hold for any parameters, as numbers" };

struct StateOptions : CommonOptions
{
  std::vector<double> loads;
  std::vector<double> steps;
  double angle{};
  int pitches{ 1 };
};

using State = StateInvariants;
const std::vector<Column<State>> STATE_COLUMNS{
  { "load", &State::load, "load [N.m]" },
  { "wave_generator_angle", &State::wave_generator_angle },
  { "output_angle", &State::output_angle },
  { "energy", &State::energy },
  { "softest_stiffness", &State::softest_stiffness },
  { "contact_force_max", &State::contact_force_max },
  { "flank_force_max", &State::flank_force_max },
  { "half_turn_position", [](const State& state) { return state.half_turn.position; }, "half turn [m]" },
  { "half_turn_contact_force", [](const State& state) { return state.half_turn.contact_force; } },
  { "half_turn_flank_force", [](const State& state) { return state.half_turn.flank_force; }, "half turn [N]" },
  { "pitch_shift_position", [](const State& state) { return state.pitch_shift.position; }, "pitch shift [m]" },
  { "pitch_shift_contact_force", [](const State& state) { return state.pitch_shift.contact_force; } },
  { "pitch_shift_flank_force", [](const State& state) { return state.pitch_shift.flank_force; }, "pitch shift [N]" },
  { "pitch_shift_energy", &State::pitch_shift_energy },
  { "wave_generator_torque", &State::wave_generator_torque },
  { "output_torque", &State::output_torque },
  { "cup_torque", &State::cup_torque },
  { "", [](const State& state) { return state.wave_generator_torque + state.output_torque + state.cup_torque; },
    "torque sum [N.m]" },
  { "residual", [](const State& row) { return row.status.residual; }, "residual [N]" }
};

using LoadedPotential = std::pair<double, PotentialRow>;
Column<LoadedPotential> ofPotential(const char* key, double PotentialRow::*value, const char* heading = "")
{
  return { key, [value](const LoadedPotential& row) { return row.second.*value; }, heading };
}
const std::vector<Column<LoadedPotential>> POTENTIAL_COLUMNS{
  { "load", &LoadedPotential::first, "load [N.m]" },
  ofPotential("wave_generator_step", &PotentialRow::wave_generator_step, "WG step [rad]"),
  ofPotential("output_step", &PotentialRow::output_step),
  ofPotential("wave_generator_torque", &PotentialRow::wave_generator_torque),
  ofPotential("wave_generator_difference", &PotentialRow::wave_generator_difference, "T + dU/d(WG) [N.m]"),
  ofPotential("output_torque", &PotentialRow::output_torque),
  ofPotential("output_difference", &PotentialRow::output_difference, "T + dU/d(output) [N.m]"),
  ofPotential("wave_generator_by_output", &PotentialRow::wave_generator_by_output, "dT(WG)/d(output) [N.m/rad]"),
  ofPotential("output_by_wave_generator", &PotentialRow::output_by_wave_generator, "dT(output)/d(WG) [N.m/rad]"),
  ofPotential("condensed_stiffness", &PotentialRow::condensed_stiffness)
};

int state(const StateOptions& options)
{
  const Parameters parameters = loadParameters(options);
  std::vector<State> states;
  std::vector<LoadedPotential> potential;
  for (const double load : options.loads)
  {
    states.push_back(analyseState(parameters, options.angle, load, options.pitches));
    if (!states.back().status.ok())
    {
      return notConverged("a load of " + shortNumber(load) + " N.m", states.back().status);
    }
    for (const PotentialRow& row : analysePotential(parameters, options.angle, load, options.steps))
    {
      if (!row.status.ok())
      {
        return notConverged("a step of " + shortNumber(row.wave_generator_step) + " rad", row.status);
      }
      potential.emplace_back(load, row);
    }
  }
  printReport(options.json, { { "pitches", "", options.pitches } },
              { { "states", { STATE_COLUMNS, states } }, { "potential", { POTENTIAL_COLUMNS, potential } } });
  return EXIT_DONE;
}

void declareState(Command& command, StateOptions& options)
{
  command.add("--loads", options.loads, "loads on the circular spline, e.g. 0,20,150 [N.m]").required();
  command.add("--angle", options.angle, "wave generator angle [rad]");
  command.add("--pitches", options.pitches, "tooth pitches of the shift [-]").range(-10000, 10000);
  command.add("--steps", options.steps, "wave generator's steps for the derivatives, e.g. 1e-4,1e-5 [rad]")
      .range(1e-9, 0.1);
  addCommonOptions(command, options);
}

const Subcommand STATE{ Subject::STUDY, "invariants state",
                        "two-fold symmetry, shift by tooth pitches, balance of torques and torques as derivatives of "
                        "the energy, at rest under load",
                        declareState, state };

struct FrameOptions : CommonOptions
{
  double load{};
  unsigned seed{ 1 };
  int samples{ 41 };
};

const std::vector<Column<TurnedElement>> ELEMENT_COLUMNS{ { "name", &TurnedElement::name },
                                                          { "force_max", &TurnedElement::force_max },
                                                          { "force_difference", &TurnedElement::force_difference },
                                                          { "energy", &TurnedElement::energy },
                                                          { "energy_difference", &TurnedElement::energy_difference },
                                                          { "torque_difference", &TurnedElement::torque_difference } };
const std::vector<Column<TurnedBending>> BENDING_COLUMNS{
  { "angle", &TurnedBending::angle, "turn [rad]" },
  { "curvature_force", &TurnedBending::curvature_force, "bending, law curvature [N]" },
  { "absolute_force", &TurnedBending::absolute_force, "bending, law absolute [N]" },
  { "curvature_energy", &TurnedBending::curvature_energy },
  { "absolute_energy", &TurnedBending::absolute_energy }
};

int frame(const FrameOptions& options)
{
  const TurnedMachine result =
      analyseTurnedMachine(loadParameters(options), options.load, options.seed, options.samples);
  if (!result.status.ok())
  {
    return notConverged("a load of " + shortNumber(options.load) + " N.m", result.status);
  }
  std::vector<ReportLine> lines{ { "load", "", options.load },
                                 { "elements", "", Table(ELEMENT_COLUMNS, result.elements).rows() } };
  for (const TurnedElement& element : result.elements)
  {
    lines.push_back({ "", element.name + ", largest change of a force", element.force_difference, "N" });
  }
  printReport(options.json, lines, { { "bending", { BENDING_COLUMNS, result.bending } } });
  return EXIT_DONE;
}

void declareFrame(Command& command, FrameOptions& options)
{
  command.add("--load", options.load, "load on the circular spline [N.m]");
  command.add("--seed", options.seed, "of the random angles [-]");
  command.add("--samples", options.samples, "angles [-]").range(1, 100000);
  addCommonOptions(command, options);
}

const Subcommand FRAME{ Subject::STUDY, "invariants frame",
                        "forces and energies of each element with the whole machine turned", declareFrame, frame };

struct SmallWaveOptions : CommonOptions
{
  double smallest{};
  int count{};
  bool hold{};
};

template <ShapeError SmallWaveRow::*ERROR>
Json errorOf(const SmallWaveRow& row)
{
  const ShapeError& error = row.*ERROR;
  return { { "radial", error.radial }, { "tangential", error.tangential }, { "tilt", error.tilt } };
}
template <ShapeError SmallWaveRow::*ERROR, double ShapeError::*PART>
Column<SmallWaveRow> partOf(const char* heading)
{
  return { "", [](const SmallWaveRow& row) { return row.*ERROR.*PART; }, heading };
}

const std::vector<Column<SmallWaveRow>> SMALL_WAVE_COLUMNS{
  { "wave_amplitude", &SmallWaveRow::wave_amplitude, "wave amplitude [m]" },
  { "teeth_in_contact", &SmallWaveRow::teeth_in_contact, "teeth in contact [-]" },
  { "residual", [](const SmallWaveRow& row) { return row.status.residual; } },
  { "contact_force_min", &SmallWaveRow::contact_force_min },
  { "contact_force_max", &SmallWaveRow::contact_force_max },
  { "thin_ring", errorOf<&SmallWaveRow::thin_ring> },
  { "linear", errorOf<&SmallWaveRow::linear> },
  { "second_order", errorOf<&SmallWaveRow::second_order> },
  partOf<&SmallWaveRow::thin_ring, &ShapeError::radial>("radial [-]"),
  partOf<&SmallWaveRow::thin_ring, &ShapeError::tangential>("tangential [-]"),
  partOf<&SmallWaveRow::thin_ring, &ShapeError::tilt>("tilt [-]"),
  partOf<&SmallWaveRow::second_order, &ShapeError::radial>("radial, 2nd order [-]"),
  partOf<&SmallWaveRow::second_order, &ShapeError::tangential>("tangential, 2nd order [-]"),
  partOf<&SmallWaveRow::second_order, &ShapeError::tilt>("tilt, 2nd order [-]")
};

int smallWave(const SmallWaveOptions& options)
{
  const WaveBending bending = options.hold ? WaveBending::PROPORTIONAL : WaveBending::KEPT;
  const auto rows = analyseSmallWave(loadParameters(options), bending, options.smallest, options.count);
  for (const SmallWaveRow& row : rows)
  {
    if (!row.status.ok())
    {
      return notConverged("a wave amplitude of " + shortNumber(row.wave_amplitude) + " m", row.status);
    }
  }
  printReport(options.json, {}, { { "rows", { SMALL_WAVE_COLUMNS, rows } } });
  return EXIT_DONE;
}

void declareSmallWave(Command& command, SmallWaveOptions& options)
{
  command.add("--smallest", options.smallest, "smallest wave amplitude [m]").required().range(1e-9, 0.01);
  command.add("--count", options.count, "amplitudes in equal ratios [-]").required().range(1, 100000);
  command.flag("--hold", options.hold,
               "bending stiffness in proportion to the amplitude: the ring touches all round at any amplitude");
  addCommonOptions(command, options);
}

const Subcommand SMALL_WAVE{ Subject::STUDY, "invariants small-wave",
                             "shape of the inserted ring against thin-ring theory, from the gear's wave amplitude down",
                             declareSmallWave, smallWave };

struct EnergyOptions : CommonOptions
{
  std::vector<double> rates;
  unsigned seed{ 1 };
  double load{ 150.0 };
  double duration{ 1.0 };
};

using RatedResult = std::pair<double, LedgerResult>;
const std::vector<Column<RatedResult>> ENERGY_COLUMNS{
  { "rate", &RatedResult::first, "rate [Hz]" },
  { "throughput", [](const RatedResult& row) { return row.second.throughput; }, "through [J]" },
  { "residual", [](const RatedResult& row) { return row.second.residual; }, "left over [J]" },
  { "relative_residual", [](const RatedResult& row) { return row.second.residual / row.second.throughput; },
    "left over / through [-]" },
  { "travel", [](const RatedResult& row) { return row.second.travel; } },
  { "top_speed", [](const RatedResult& row) { return row.second.top_speed; }, "top speed [rad/s]" },
  { "reversals", [](const RatedResult& row) { return row.second.reversals; } }
};

int energy(const EnergyOptions& options)
{
  Parameters parameters = loadParameters(options);
  const std::vector<double> rates =
      options.rates.empty() ? std::vector<double>{ parameters.solver.rate } : options.rates;
  std::vector<RatedResult> rows;
  for (const double rate : rates)
  {
    parameters.solver.rate = rate;
    rows.emplace_back(rate, runLedger(parameters, { options.seed, options.load, true }, options.duration,
                                      showProgress("random motion at " + shortNumber(rate) + " Hz")));
    if (!rows.back().second.status.ok())
    {
      return notConverged("a step at " + shortNumber(rate) + " Hz", rows.back().second.status);
    }
  }
  printReport(options.json, { { "seed", "", options.seed }, { "duration", "", options.duration } },
              { { "rows", { ENERGY_COLUMNS, rows } } });
  return EXIT_DONE;
}

void declareEnergy(Command& command, EnergyOptions& options)
{
  command.add("--rates", options.rates, "step rates, e.g. 10000,50000 [Hz]; default: solver.rate").range(100.0, 1e6);
  command.add("--seed", options.seed, "of the random torques [-]");
  command.add("--load", options.load, "largest load, either way [N.m]").atLeast(0.0);
  command.add("--duration", options.duration, "simulated time [s]").range(1e-3, 1e4);
  addCommonOptions(command, options);
}

const Subcommand ENERGY{ Subject::STUDY, "invariants energy",
                         "energy ledger over a random motion with reversals, load and brake", declareEnergy, energy };
}  // namespace
}  // namespace hjt
