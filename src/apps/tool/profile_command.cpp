// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include <vector>

#include "apps/common/configuration.hpp"
#include "output/exit_code.hpp"
#include "output/report.hpp"

#include "gear/flank_shapes.hpp"
#include "gear/tooth_profile.hpp"

namespace hjt
{
namespace
{
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

struct ProfilePoint
{
  double drop{};
  double half_clearance{};
  double flank_angle{};
  double path{};
};
const std::vector<Column<ProfilePoint>> COLUMNS{ { "drop", &ProfilePoint::drop, "drop [m]" },
                                                 { "half_clearance", &ProfilePoint::half_clearance,
                                                   "half clearance [m]" },
                                                 { "flank_angle", &ProfilePoint::flank_angle, "flank angle [rad]" },
                                                 { "path", &ProfilePoint::path, "path of the tooth [m]" } };

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
  std::vector<ProfilePoint> points;
  for (int i = 0; i <= INTERVALS; ++i)
  {
    const double drop = path.entry() * i / INTERVALS;
    const HalfClearance at = profile.at(full_engagement - drop);
    points.push_back({ drop, at.value, std::atan(at.slope), path.across(drop) });
  }
  const Table clearance(COLUMNS, points);
  if (!options.json)
  {
    clearance.print();
    return EXIT_DONE;
  }
  const FlankShapes flanks(parameters.mesh, gear, INTERVALS, INTERVALS / 10);
  printReport(true, { { "clearance", "", clearance.columns() },
                      { "tooth.below_tip", "", steps(flanks.tooth.size(), flanks.step) },
                      { "tooth.half_thickness", "", asVector(flanks.tooth) },
                      { "space.above_tip", "", steps(flanks.space.size(), flanks.step) },
                      { "space.half_width", "", asVector(flanks.space) } });
  return EXIT_DONE;
}

const Subcommand PROFILE{ Subject::GEAR, "profile",
                          "half clearance of the tooth flanks over the drop from full engagement, and the path of a "
                          "tooth on the ideal ring; with --json also the shapes of tooth and space",
                          addCommonOptions, profile };
}  // namespace
}  // namespace hjt
