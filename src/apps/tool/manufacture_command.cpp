// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/common/configuration.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/text_table.hpp"
#include "apps/tool/commands.hpp"

#include "gear/manufacture_errors.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

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
  if (options.json)
  {
    const ManufactureErrors errors(parameters.manufacture, parameters.gear);
    std::cout << Json{
      { "flexspline",
        { { "total_pitch_deviation", totalDeviation(flexspline) },
          { "single_pitch_deviation", singleDeviation(flexspline) },
          { "pitch_deviation", list(flexspline) } } },
      { "circular_spline",
        { { "total_pitch_deviation", totalDeviation(circular_spline) },
          { "single_pitch_deviation", singleDeviation(circular_spline) },
          { "pitch_deviation", list(circular_spline) },
          { "across", list(errors.space_across) },
          { "along", list(errors.space_along) } } }
    }.dump(2) << '\n';
    return EXIT_DONE;
  }
  printValues({ { "flexspline, total pitch deviation", shortNumber(totalDeviation(flexspline)), "m" },
                { "flexspline, largest of one pitch", shortNumber(singleDeviation(flexspline)), "m" },
                { "circular spline, total pitch deviation", shortNumber(totalDeviation(circular_spline)), "m" },
                { "circular spline, largest of one pitch", shortNumber(singleDeviation(circular_spline)), "m" } });
  return EXIT_DONE;
}
}  // namespace

void addManufactureCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<ManufactureOptions>();
  auto* command = app.add_subcommand("manufacture", "errors of manufacture of every tooth and space [m]");
  command->add_option("--flexspline-csv", options->flexspline_csv, "write the flexspline's pitch deviations")
      ->type_name("FILE");
  command
      ->add_option("--circular-spline-csv", options->circular_spline_csv,
                   "write the circular spline's pitch deviations")
      ->type_name("FILE");
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = manufacture(*options); });
}
}  // namespace hjt
