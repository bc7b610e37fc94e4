// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/common/configuration.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/common/text_table.hpp"
#include "apps/tool/commands.hpp"

#include "gear/flank_shapes.hpp"
#include "gear/tooth_profile.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

std::vector<double> steps(Eigen::Index count, double step)
{
  std::vector<double> values;
  for (Eigen::Index i = 0; i < count; ++i)
  {
    values.push_back(step * static_cast<double>(i));
  }
  return values;
}

std::vector<double> asVector(const Eigen::VectorXd& values)
{
  return { values.data(), values.data() + values.size() };
}

int profile(const CommonOptions& options)
{
  constexpr int INTERVALS = 100;
  const Parameters parameters = loadParameters(options);
  const GearParameters& gear = parameters.gear;
  if (gear.engagementDepth() <= 0.0)
  {
    std::cerr << "joint_twin: the teeth do not reach into the circular spline; see gear.tip_radius_circular_spline\n";
    return EXIT_FAILED;
  }
  const EngagementPath path(gear);
  const ToothProfile profile(parameters.mesh, gear);
  const double full_engagement = gear.flexspline_inner_radius + gear.toothMidHeight() + gear.wave_amplitude;
  Json clearance{ { "drop", {} }, { "half_clearance", {} }, { "flank_angle", {} }, { "path", {} } };
  std::vector<std::vector<double>> table;
  for (int i = 0; i <= INTERVALS; ++i)
  {
    const double drop = path.entry() * i / INTERVALS;
    const HalfClearance at = profile.at(full_engagement - drop);
    const double angle = std::atan(at.slope);
    clearance["drop"].push_back(drop);
    clearance["half_clearance"].push_back(at.value);
    clearance["flank_angle"].push_back(angle);
    clearance["path"].push_back(path.across(drop));
    table.push_back({ drop, at.value, angle, path.across(drop) });
  }
  if (options.json)
  {
    const FlankShapes flanks(parameters.mesh, gear, INTERVALS, INTERVALS / 10);
    const Json tooth{ { "below_tip", steps(flanks.tooth.size(), flanks.step) },
                      { "half_thickness", asVector(flanks.tooth) } };
    const Json space{ { "above_tip", steps(flanks.space.size(), flanks.step) },
                      { "half_width", asVector(flanks.space) } };
    std::cout << Json{ { "clearance", clearance }, { "tooth", tooth }, { "space", space } }.dump(2) << '\n';
    return EXIT_DONE;
  }
  printTable({ "drop [m]", "half clearance [m]", "flank angle [rad]", "path of the tooth [m]" }, table);
  return EXIT_DONE;
}
}  // namespace

void addProfileCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<CommonOptions>();
  auto* command =
      app.add_subcommand("profile",
                         "half clearance of the tooth flanks over the drop from full engagement, beside the "
                         "path of a tooth on the ideal ring; with --json also the shapes of tooth and space");
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = profile(*options); });
}
}  // namespace hjt
