// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <limits>
#include <memory>

#include <nlohmann/json.hpp>

#include "apps/common/configuration.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/common/not_converged.hpp"
#include "apps/common/progress.hpp"
#include "apps/common/text_table.hpp"
#include "apps/common/validators.hpp"
#include "apps/tool/commands.hpp"

#include "studies/ratchet_analysis.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

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
                                            "no equilibrium";
}

Json rowJson(const RatchetRow& row)
{
  return { { "output_angle", row.output_angle },
           { "torque", row.torque },
           { "wave_amplitude", row.wave_amplitude },
           { "lobe_force", row.lobe_force },
           { "depth_max", row.depth_max },
           { "mesh_force_max", row.mesh_force_max },
           { "wave_generator_force_max", row.wave_generator_force_max },
           { "teeth_loaded", row.teeth_loaded },
           { "snaps", row.snaps },
           { "teeth_jumped", row.teeth_jumped } };
}

int ratchet(const RatchetOptions& options)
{
  const Parameters parameters = loadParameters(options);
  RatchetResult result;
  {
    Progress progress("loading");
    result = analyseRatchet(parameters, options.angle, options.lobe_stiffness, options.angle_step, options.torque_limit,
                            [&](double done) { progress.update(done); });
  }
  if (!result.status.ok())
  {
    return notConverged("no load", result.status);
  }
  if (options.json)
  {
    Json rows = Json::array();
    for (const RatchetRow& row : result.rows)
    {
      rows.push_back(rowJson(row));
    }
    std::cout << Json{ { "end", endOf(result.end) }, { "peak", rowJson(result.peak) }, { "rows", rows } }.dump(2)
              << '\n';
    return EXIT_DONE;
  }
  const RatchetRow& peak = result.peak;
  printValues({ { "end", endOf(result.end), "" },
                { "largest torque", shortNumber(peak.torque), "N.m" },
                { "output angle there", shortNumber(peak.output_angle), "rad" },
                { "wave amplitude left", shortNumber(peak.wave_amplitude), "m" },
                { "force on each lobe", shortNumber(peak.lobe_force), "N" },
                { "deepest tooth", shortNumber(peak.depth_max), "m" },
                { "mesh force, largest", shortNumber(peak.mesh_force_max), "N" },
                { "wave generator force, largest", shortNumber(peak.wave_generator_force_max), "N" },
                { "snaps before", std::to_string(peak.snaps), "" },
                { "teeth jumped", std::to_string(peak.teeth_jumped), "" },
                { "teeth loaded", std::to_string(peak.teeth_loaded), "" } });
  return EXIT_DONE;
}
}  // namespace

void addRatchetCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<RatchetOptions>();
  auto* command = app.add_subcommand("ratchet",
                                     "jump of the teeth: wave generator locked, output driven until the "
                                     "torque falls, friction left out");
  command
      ->add_option("--lobe-stiffness", options->lobe_stiffness,
                   "radial stiffness of each lobe of the wave generator, default rigid [N/m]")
      ->check(FINITE)
      ->check(CLI::Range(1e3, 1e15));
  command->add_option("--angle", options->angle, "wave generator angle [rad]")->check(FINITE);
  command->add_option("--angle-step", options->angle_step, "step of the output angle [rad]")
      ->check(FINITE)
      ->check(CLI::Range(1e-6, 1e-2))
      ->capture_default_str();
  command->add_option("--torque-limit", options->torque_limit, "ends the search if nothing has jumped [N.m]")
      ->check(FINITE)
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = ratchet(*options); });
}
}  // namespace hjt
