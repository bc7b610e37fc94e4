// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "apps/common/configuration.hpp"
#include "output/exit_code.hpp"
#include "output/report.hpp"

#include "gear/manufacture_errors.hpp"

namespace hjt
{
namespace
{
struct ManufactureOptions : CommonOptions
{
  std::string flexspline_csv;
  std::string circular_spline_csv;
};

std::vector<double> list(const Eigen::VectorXd& values)
{
  return { values.data(), values.data() + values.size() };
}

/// Fp: largest less smallest cumulative deviation [m].
double totalDeviation(const Eigen::VectorXd& pitch)
{
  return pitch.maxCoeff() - pitch.minCoeff();
}

/// fp: largest error of the distance between neighbours [m].
double singleDeviation(const Eigen::VectorXd& pitch)
{
  double largest = 0.0;
  for (Eigen::Index i = 0; i < pitch.size(); ++i)
  {
    largest = std::max(largest, std::abs(pitch[(i + 1) % pitch.size()] - pitch[i]));
  }
  return largest;
}

/// In the form the parameters of the tables take.
void writePitch(const std::string& path, const Eigen::VectorXd& pitch)
{
  CsvWriter csv(path, { "tooth", "deviation" });
  for (Eigen::Index i = 0; i < pitch.size(); ++i)
  {
    csv.writeRow({ static_cast<double>(i), pitch[i] });
  }
  csv.close();
}

int manufacture(const ManufactureOptions& options)
{
  const Parameters parameters = loadParameters(options);
  const Eigen::VectorXd flexspline = flexsplinePitch(parameters.manufacture, parameters.gear);
  const Eigen::VectorXd circular_spline = circularSplinePitch(parameters.manufacture, parameters.gear);
  for (const auto& [path, pitch] : { std::make_pair(options.flexspline_csv, flexspline),
                                     std::make_pair(options.circular_spline_csv, circular_spline) })
  {
    if (!path.empty())
    {
      requireWritable(path, options.force);
      writePitch(path, pitch);
    }
  }
  const ManufactureErrors errors(parameters.manufacture, parameters.gear);
  printReport(
      options.json,
      { { "flexspline.total_pitch_deviation", "flexspline, total pitch deviation", totalDeviation(flexspline), "m" },
        { "flexspline.single_pitch_deviation", "flexspline, largest of one pitch", singleDeviation(flexspline), "m" },
        { "flexspline.pitch_deviation", "", list(flexspline) },
        { "flexspline.across", "", list(errors.tooth_across) },
        { "flexspline.along", "", list(errors.tooth_along) },
        { "circular_spline.total_pitch_deviation", "circular spline, total pitch deviation",
          totalDeviation(circular_spline), "m" },
        { "circular_spline.single_pitch_deviation", "circular spline, largest of one pitch",
          singleDeviation(circular_spline), "m" },
        { "circular_spline.pitch_deviation", "", list(circular_spline) },
        { "circular_spline.across", "", list(errors.space_across) },
        { "circular_spline.along", "", list(errors.space_along) } });
  return EXIT_DONE;
}

void declare(OptionTable& table, ManufactureOptions& options)
{
  table.add("--flexspline-csv", options.flexspline_csv, "write the flexspline's pitch deviations").type("FILE");
  table.add("--circular-spline-csv", options.circular_spline_csv, "write the circular spline's pitch deviations")
      .type("FILE");
  addCommonOptions(table, options);
}

const Subcommand MANUFACTURE{ Subject::GEAR, "manufacture", "errors of manufacture of every tooth and space [m]",
                              declare, manufacture };
}  // namespace
}  // namespace hjt
