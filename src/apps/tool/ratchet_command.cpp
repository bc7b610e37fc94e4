// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <limits>

#include "apps/common/configuration.hpp"
#include "apps/common/not_converged.hpp"
#include "output/exit_code.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "output/text_table.hpp"

#include "studies/ratchet_analysis.hpp"

namespace hjt
{
namespace
{
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
                              { "peak.output_angle", "output angle there", peak.output_angle, "rad" },
                              { "peak.wave_amplitude", "wave amplitude left", peak.wave_amplitude, "m" },
                              { "peak.lobe_force", "force on each lobe", peak.lobe_force, "N" },
                              { "peak.depth_max", "deepest tooth", peak.depth_max, "m" },
                              { "peak.mesh_force_max", "mesh force, largest", peak.mesh_force_max, "N" },
                              { "peak.wave_generator_force_max", "wave generator force, largest",
                                peak.wave_generator_force_max, "N" },
                              { "peak.snaps", "snaps before", peak.snaps },
                              { "peak.teeth_jumped", "teeth jumped", peak.teeth_jumped },
                              { "peak.teeth_loaded", "teeth loaded", peak.teeth_loaded },
                              { "rows", "", Table(RATCHET_COLUMNS, result.rows).rows() } });
  if (result.end == RatchetEnd::NO_EQUILIBRIUM)
  {
    std::cerr << "joint_twin: the search gave up: no equilibrium found a step of " << shortNumber(options.angle_step)
              << " rad beyond " << shortNumber(result.rows.empty() ? 0.0 : result.rows.back().output_angle)
              << " rad; the torque has not fallen, the largest is a lower bound of the jump\n";
    return EXIT_FAILED;
  }
  return EXIT_DONE;
}

void declare(OptionTable& table, RatchetOptions& options)
{
  table
      .add("--lobe-stiffness", options.lobe_stiffness,
           "radial stiffness of each lobe with plug and circular spline in its housing, some 1e8 at size 25 "
           "(docs/model.md, Jump) [N/m]; default rigid, which makes the largest torque an upper bound")
      .range(1e3, 1e15);
  table.add("--angle", options.angle, "wave generator angle [rad]");
  table.add("--angle-step", options.angle_step, "step of the output angle [rad]").range(1e-6, 1e-2);
  table.add("--torque-limit", options.torque_limit, "ends the search if nothing has jumped [N.m]").range(1.0, 1e6);
  addFaultOption(table, options);
  addCommonOptions(table, options);
}

const Subcommand RATCHET{
  Subject::GEAR, "ratchet",
  "jump of the teeth: wave generator locked, output driven until the torque falls, friction left out", declare, ratchet
};
}  // namespace
}  // namespace hjt
