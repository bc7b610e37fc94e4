// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "apps/common/configuration.hpp"
#include "base/number_text.hpp"
#include "base/whole_file.hpp"
#include "gear/angle.hpp"
#include "gear/manufacture_errors.hpp"
#include "gear/tooth_profile.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/statics/loss_analysis.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "output/process_end.hpp"
#include "output/report.hpp"
#include "params/field_table.hpp"
#include "params/variants.hpp"
#include "statics/gear_design.hpp"

namespace hjt
{
namespace
{
constexpr double ARCMIN = PI / 180.0 / 60.0;
constexpr int DIGITS = 6;  // significant digits of a value in the overlay

struct GearOptions : CommonOptions
{
  GearRequest request;
  std::string out;
};

struct Figure
{
  std::string name;
  double catalogue;  // value of the figure in the catalogue, in `unit`; 0 if the catalogue has none
  double gear;
  std::string unit;
};
const std::vector<Column<Figure>> FIGURE_COLUMNS{
  { "name", [](const Figure& figure) { return figure.name; }, "figure" },
  { "catalogue", [](const Figure& figure) { return figure.catalogue > 0.0 ? Json(figure.catalogue) : Json(); },
    "catalogue" },
  { "gear", [](const Figure& figure) { return figure.gear; }, "gear" },
  { "unit", [](const Figure& figure) { return figure.unit; }, "unit" }
};

std::string rounded(double value)
{
  return numberText(decimalNumber(roundedText(value, DIGITS)).value());
}

std::string yamlValue(const ParameterValue& value)
{
  if (const auto* list = std::get_if<std::vector<double>>(&value.value))
  {
    std::string text;
    for (const double part : *list)
    {
      text += (text.empty() ? "[" : ", ") + rounded(part);
    }
    return text + "]";
  }
  const auto* number = std::get_if<double>(&value.value);
  return number ? rounded(*number) : valueText(value);
}

std::map<std::string, std::string> meanings(const Parameters& parameters)
{
  std::map<std::string, std::string> texts;
  visitFields(parameters,
              [&](const std::string& key, const auto& first, const auto&... rest)
              {
                if constexpr (sizeof...(rest) == 3)  // a number: `first` is its unit; `rest` is value, range, meaning
                {
                  const Meaning& meaning = std::get<2>(std::tie(rest...));
                  texts[key] = std::string(meaning.text) + " [" + first + "]";
                }
              });
  return texts;
}

/// Writes the overlay, with a comment above each value. @throws InputError if the file cannot be written.
void write(const GearOptions& options, const GearDesign& design, const Parameters& parameters, const std::string& title)
{
  std::map<std::string, std::vector<DesignedParameter>> sections;
  for (const DesignedParameter& parameter : design.parameters)
  {
    sections[parameter.key.substr(0, parameter.key.find('.'))].push_back(parameter);
  }
  const auto texts = meanings(parameters);
  TextStream file;
  file << "# Overlay: " << title
       << ".\n# Made by joint_twin gear. The overlay changes only the gear: motor, brake, output.*_inertia,\n"
          "# output.torque_limit, thermal and sensors stay as configured.\n";
  for (const auto& [section, members] : sections)
  {
    file << '\n' << section << ":\n";
    for (const DesignedParameter& parameter : members)
    {
      file << "  # " << texts.at(parameter.key) << ". From: " << parameter.rule << ".\n  "
           << parameter.key.substr(section.size() + 1) << ": " << yamlValue(design.map.at(parameter.key)) << '\n';
    }
  }
  writeTextFile(options.out, file.str());
}

std::vector<Figure> figuresOf(const Parameters& designed, const GearFigures& catalogue)
{
  Parameters parameters = withoutHeat(designed);
  parameters.input.temperature = CATALOGUE_TEMPERATURE;
  std::vector<Figure> figures;
  const std::vector<double> torques{ 0.0, catalogue.breakpoints[0], catalogue.breakpoints[1], catalogue.rated_torque,
                                     catalogue.repeated_peak_torque };
  const std::vector<StiffnessRow> rows = analyseStiffness(parameters, 0.0, torques);
  for (const StiffnessRow& row : rows)
  {
    if (!row.status.ok())
    {
      throw ParameterError("there is no equilibrium under " + numberText(row.torque) +
                           " N.m: " + explanationOf(row.status));
    }
    if (row.torque > 0.0)
    {
      figures.push_back({ "torsion at " + shortNumber(row.torque) + " N.m", catalogue.torsion(row.torque) / ARCMIN,
                          -row.output_angle / ARCMIN, "arcmin" });
    }
  }
  const Breakaway breakaway = analyseBreakaway(parameters, FRICTION_POSITIONS);
  const auto losses =
      analyseLosses(parameters, { CATALOGUE_SPEED }, { 0.0, catalogue.rated_torque }, FRICTION_POSITIONS, nullptr);
  figures.push_back({ "starting torque", 1e3 * catalogue.starting_torque, 1e3 * breakaway.starting, "mN.m" });
  figures.push_back({ "back-driving torque", 0.0, breakaway.back_driving, "N.m" });
  figures.push_back(
      { "no-load torque at 2000 rpm", 1e3 * catalogue.no_load_torque, 1e3 * losses[0].loss.gear(), "mN.m" });
  figures.push_back({ "efficiency at the rated torque", 0.0, 100.0 * losses[1].gear_efficiency, "%" });
  const double share = 100.0 / parameters.gear.teeth_flexspline;
  figures.push_back({ "teeth in mesh without load", 0.0, share * rows[0].teeth_loaded, "%" });
  figures.push_back({ "teeth in mesh at the rated torque", 0.0, share * rows[3].teeth_loaded, "%" });
  return figures;
}

int gear(const GearOptions& options)
{
  ParameterMap map = defaultParameterMap(options);
  addOverlays(options, map);
  requireWritable(options.out, options.force);
  const GearFigures catalogue = gearFigures(options.request);
  const GearDesign design = designGear(map, options.request, catalogue);
  const Parameters parameters = parseParameters(design.map);
  write(options, design, parameters,
        "a gear of size " + shortNumber(options.request.size) + ", ratio " + std::to_string(options.request.ratio));
  printGearWarnings(parameters);
  const GearRequest& request = options.request;
  const bool own = !request.stiffness.empty() || !request.breakpoints.empty() || !request.ratings.empty() ||
                   request.starting_torque || request.no_load_torque;
  const std::string of_own = own ? "as given, else " : "";
  printReport(options.json, { { "catalogue", "catalogue's figures", of_own + catalogue.source } },
              { { "figures", Table(FIGURE_COLUMNS, figuresOf(parameters, catalogue)) } });
  return EXIT_DONE;
}

std::string invalidRatio(const std::string& text)
{
  const std::optional<double> ratio = decimalNumber(text);
  return ratio && *ratio >= 30.0 && *ratio <= 320.0 ? "" : "a ratio is a whole number from 30 to 320";
}

void declare(OptionTable& table, GearOptions& options)
{
  table.add("--size", options.request.size, "size of the gear, as catalogues number it: 11, 14, 17, 20, 25, 32 ...")
      .range(5, 100);
  table
      .add("--ratio", options.request.ratio,
           "ratio with the circular spline held: half the number of the flexspline's teeth")
      .check(invalidRatio);
  table.add("--bore-radius", options.request.bore_radius, "inner radius of the flexspline [m]").positive();
  table.add("--rim-thickness", options.request.rim_thickness, "thickness of the flexspline's rim under the teeth [m]")
      .positive();
  table.add("--face-width", options.request.face_width, "length of the teeth [m]").positive();
  table.add("--stiffness", options.request.stiffness,
            "K1,K2,K3 of your catalogue [N.m/rad]; default: those of the catalogue HFUS/CSF");
  table.add("--breakpoints", options.request.breakpoints,
            "torques T1,T2 of your catalogue, at which the stiffness changes [N.m]");
  table.add("--ratings", options.request.ratings,
            "torques of your catalogue: rated, average, repeated peak, momentary peak [N.m]");
  table.add("--starting-torque", options.request.starting_torque, "starting torque of your catalogue at 20 degC [N.m]")
      .positive();
  table
      .add("--no-load-torque", options.request.no_load_torque,
           "no-load torque of your catalogue at 2000 rpm and 20 degC [N.m]")
      .positive();
  table.add("--out", options.out, "file for the overlay, to be used with --config").type("FILE").required();
  addCommonOptions(table, options);
}

const Subcommand GEAR{ Subject::GEAR, "gear", "design a gear by its size and ratio, as a configuration overlay",
                       declare, gear };

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
                          "half clearance of the tooth flanks over the drop, the radial distance of a tooth from full "
                          "engagement; path of a tooth on the ideal ring; with --json also shapes of tooth and space",
                          addCommonOptions, profile };

struct ManufactureOptions : CommonOptions
{
  std::string flexspline_csv;
  std::string circular_spline_csv;
};

std::vector<double> list(const Eigen::VectorXd& values)
{
  return { values.data(), values.data() + values.size() };
}

/// Fp: largest minus smallest cumulative pitch deviation [m].
double totalDeviation(const Eigen::VectorXd& pitch)
{
  return pitch.maxCoeff() - pitch.minCoeff();
}

/// fp: largest error of the distance between two neighbouring teeth [m].
double singleDeviation(const Eigen::VectorXd& pitch)
{
  double largest = 0.0;
  for (Eigen::Index i = 0; i < pitch.size(); ++i)
  {
    largest = std::max(largest, std::abs(pitch[(i + 1) % pitch.size()] - pitch[i]));
  }
  return largest;
}

/// Writes the deviations as the CSV file that manufacture.flexspline_pitch_table and
/// manufacture.circular_spline_pitch_table name.
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
        { "flexspline.single_pitch_deviation", "flexspline, largest single pitch deviation",
          singleDeviation(flexspline), "m" },
        { "flexspline.pitch_deviation", "", list(flexspline) },
        { "flexspline.across", "", list(errors.tooth_across) },
        { "flexspline.along", "", list(errors.tooth_along) },
        { "circular_spline.total_pitch_deviation", "circular spline, total pitch deviation",
          totalDeviation(circular_spline), "m" },
        { "circular_spline.single_pitch_deviation", "circular spline, largest single pitch deviation",
          singleDeviation(circular_spline), "m" },
        { "circular_spline.pitch_deviation", "", list(circular_spline) },
        { "circular_spline.across", "", list(errors.space_across) },
        { "circular_spline.along", "", list(errors.space_along) } });
  return EXIT_DONE;
}

void declare(OptionTable& table, ManufactureOptions& options)
{
  table.add("--flexspline-csv", options.flexspline_csv, "file for the flexspline's pitch deviations").type("FILE");
  table.add("--circular-spline-csv", options.circular_spline_csv, "file for the circular spline's pitch deviations")
      .type("FILE");
  addCommonOptions(table, options);
}

const Subcommand MANUFACTURE{ Subject::GEAR, "manufacture", "errors of manufacture of every tooth and space [m]",
                              declare, manufacture };
}  // namespace
}  // namespace hjt
