// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/comparison_files.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "output/report.hpp"

#include "base/whole_file.hpp"
#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "harmonic_joint_twin/statics/torsion_loop.hpp"
#include "health/baseline_file.hpp"
#include "tracking/sound_joint.hpp"

namespace hjt
{
namespace
{
void writeCourse(const std::string& path, const RecordingComparison& comparison)
{
  const std::vector<Column<ComparedRow>> columns{
    { "time", [](const ComparedRow& row) { return row.measured.time; } },
    { "position", [](const ComparedRow& row) { return row.measured.position; } },
    { "velocity", [](const ComparedRow& row) { return row.measured.velocity; } },
    { "load", [](const ComparedRow& row) { return row.measured.load; } },
    { "current_measured", [](const ComparedRow& row) { return row.measured.current; } },
    { "current_predicted", [](const ComparedRow& row) { return row.predicted.current; } },
    { "current_band", [](const ComparedRow& row) { return row.predicted.band; } },
    { "friction_torque", [](const ComparedRow& row) { return row.predicted.friction_torque; } }
  };
  writeTable(path, columns, comparison.course().rows());
}

void writeFriction(const std::string& directory, const RecordingComparison& comparison)
{
  const std::vector<Column<FrictionPoint>> columns{ { "speed", &FrictionPoint::speed },
                                                    { "measured", &FrictionPoint::measured },
                                                    { "deviation", &FrictionPoint::deviation },
                                                    { "twin", &FrictionPoint::twin },
                                                    { "rows", &FrictionPoint::rows } };
  const std::vector<FrictionPoint> points = comparison.evidence().friction().points();
  writeTable(directory + "/" + FRICTION_FILE, columns, points);
  double fastest = 1.0;
  for (const FrictionPoint& point : points)
  {
    fastest = std::max(fastest, std::abs(point.speed));
  }
  constexpr int STEPS = 100;
  CsvWriter curve(directory + "/friction_twin.csv", { "speed", "at_typical_load", "at_largest_load" });
  for (int i = 1; i <= STEPS; ++i)
  {
    const double speed = 1.1 * fastest * i / STEPS;
    const auto at = [&](double load)
    { return comparison.evidence().twin().frictionAt(speed, load, comparison.evidence().temperature()); };
    curve.writeRow({ speed, at(comparison.evidence().typicalLoad()), at(comparison.evidence().largestLoad()) });
  }
  curve.close();
}

void writeSpectrum(const std::string& path, const RecordingComparison& comparison)
{
  const std::vector<Column<SpectrumLine>> columns{ { "order", &SpectrumLine::order },
                                                   { "forward", &SpectrumLine::forward },
                                                   { "backward", &SpectrumLine::backward } };
  writeTable(path, columns, comparison.spectrum().lines());
}

void writeTorsion(const std::string& directory, const RecordingComparison& comparison, const Parameters& parameters)
{
  if (comparison.evidence().torsion().rows() == 0)
  {
    return;
  }
  const std::vector<Column<TorsionMean>> columns{ { "torque", &TorsionMean::torque },
                                                  { "forward", &TorsionMean::forward },
                                                  { "backward", &TorsionMean::backward } };
  const std::vector<TorsionMean> means = comparison.evidence().torsion().means();
  writeTable(directory + "/torsion.csv", columns, means);
  double largest = 0.0;
  for (const TorsionMean& mean : means)
  {
    largest = std::max(largest, std::abs(mean.torque));
  }
  constexpr int STEPS = 60;
  const double lost_motion = parameters.indicators.lost_motion_torque;
  const TorsionLoop loop = analyseTorsionLoop(parameters, std::max(largest, 2.0 * lost_motion), lost_motion, STEPS);
  const std::vector<Column<TorsionPoint>> curve{ { "torque", &TorsionPoint::torque },
                                                 { "torsion", &TorsionPoint::output_angle } };
  writeTable(directory + "/torsion_twin.csv", curve, loop.points);
}

/// Every tooth of the twin's ring under the recording's typical and largest load.
void writeTeeth(const std::string& path, const RecordingComparison& comparison, const Parameters& parameters)
{
  const std::vector<StiffnessRow> rows =
      analyseStiffness(parameters, 0.0, { comparison.evidence().typicalLoad(), comparison.evidence().largestLoad() });
  CsvWriter csv(path, { "x", "y", "wave_generator_typical", "mesh_typical", "wave_generator_largest", "mesh_largest" });
  const ToothTable& typical = rows[0].teeth;
  const ToothTable& largest = rows[1].teeth;
  for (std::size_t i = 0; i < typical.tooth_x.size(); ++i)
  {
    csv.writeRow({ typical.tooth_x[i], typical.tooth_y[i], typical.wave_generator_force[i], typical.mesh_force[i],
                   largest.wave_generator_force[i], largest.mesh_force[i] });
  }
  csv.close();
}

void writeTwinStates(const std::string& path, const Decimated<TwinState>& states)
{
  if (states.rows().empty())
  {
    return;
  }
  const std::vector<Column<TwinState>> columns{ { "time", &TwinState::time },
                                                { "position", &TwinState::position },
                                                { "velocity", &TwinState::velocity },
                                                { "motor_current", &TwinState::motor_current } };
  writeTable(path, columns, states.rows());
}

/// One indicator of the window that was judged worst.
struct HealthRow
{
  std::size_t indicator{};
  double value{};
  Deviation deviation;
};

Json healthJson(const RecordingComparison& comparison)
{
  std::vector<HealthRow> rows;
  for (std::size_t i = 0; comparison.evidence().worst() && i < INDICATOR_COUNT; ++i)
  {
    const JudgedWindow& window = *comparison.evidence().worst();
    if (std::isfinite(window.indicators.values[i]) && std::isfinite(window.deviations[i].score))
    {
      rows.push_back({ i, window.indicators.values[i], window.deviations[i] });
    }
  }
  const double threshold = comparison.evidence().assessor().baseline().threshold();
  const std::vector<Column<HealthRow>> columns{
    { "indicator", [](const HealthRow& row) { return indicatorName(row.indicator); } },
    { "unit", [](const HealthRow& row) { return indicatorUnit(row.indicator); } },
    { "value", &HealthRow::value },
    { "reference", [](const HealthRow& row) { return row.deviation.expected; } },
    { "spread", [](const HealthRow& row) { return row.deviation.spread; } },
    { "score", [](const HealthRow& row) { return row.deviation.score; } },
    { "threshold", [threshold](const HealthRow&) { return threshold; } }
  };
  return Table(columns, rows).rows();
}

Json contentsJson(const RecordingContents& contents)
{
  const std::vector<Column<ContentLine>> columns{ { "name", &ContentLine::name },
                                                  { "gives", &ContentLine::gives },
                                                  { "found", &ContentLine::found },
                                                  { "messages", &ContentLine::messages } };
  return { { "topics", Table(columns, contents.lines).rows() },
           { "joints", contents.joints },
           { "not_used", contents.other_topics } };
}

Json namesOf(const std::vector<WeightedCause>& causes)
{
  std::vector<std::string> names;
  for (const WeightedCause& cause : causes)
  {
    names.emplace_back(causeName(cause.cause));
  }
  return names;
}

/// With what else a page shows.
Json verdictJson(const Verdict& verdict)
{
  const std::vector<Column<Finding>> columns{
    { "title", [](const Finding& finding) { return subjectTitle(finding.subject); } },
    { "level", [](const Finding& finding) { return levelName(finding.level); } },
    { "reason", [](const Finding& finding) { return reasonName(finding.reason); } },
    { "text", [&](const Finding& finding) { return findingText(verdict, finding); } },
    { "causes", [](const Finding& finding) { return namesOf(finding.causes); } }
  };
  Json all = verdictFields(verdict);
  all["findings"] = Table(columns, verdict.findings).rows();
  all["cannot_show"] = verdict.cannot_show;
  return all;
}
}  // namespace

Json verdictFields(const Verdict& verdict)
{
  const std::vector<WeightedCause> causes = causesOf(verdict);
  std::vector<double> weights;
  for (const WeightedCause& cause : causes)
  {
    weights.push_back(cause.weight);
  }
  std::vector<std::string> names;
  std::vector<double> values;
  std::vector<std::string> units;
  for (const NamedFigure& figure : evidenceOf(verdict))
  {
    names.push_back(figure.name);
    values.push_back(figure.value);
    units.emplace_back(figure.unit);
  }
  return { { "joint", verdict.joint },
           { "level", levelName(verdict.level) },
           { "reason", reasonName(verdict.reason) },
           { "friction_measured", std::isfinite(verdict.friction.factor) },
           { "friction_factor", verdict.friction.factor },
           { "friction_lower", verdict.friction.lower },
           { "friction_upper", verdict.friction.upper },
           { "friction_has_interval", verdict.friction.has_interval },
           { "causes", namesOf(causes) },
           { "cause_weights", weights },
           { "evidence_names", names },
           { "evidence_values", values },
           { "evidence_units", units },
           { "text", verdictText(verdict) } };
}

namespace
{
/// Standard deviation of the friction by its scatter, as a share; NaN: it was not judged by the joint's own rows, which
/// are no reference then.
double frictionDeviation(const ComparisonRecord& record)
{
  return record.is_friction_judged && record.friction.isJudged() ? record.friction.scatter :
                                                                   std::numeric_limits<double>::quiet_NaN();
}

/// Friction factor after division by the arm's common factor; null: not judged.
Json factorJson(const ComparisonRecord& record)
{
  const JudgedFriction& friction = record.verdict.friction;
  return record.is_friction_judged ? Json{ { "value", friction.factor },
                                           { "low", friction.lower },
                                           { "high", friction.upper },
                                           { "lowest_sound", record.verdict[Figure::FRICTION_LOWEST] },
                                           { "highest_sound", record.verdict[Figure::FRICTION_HIGHEST] },
                                           { "shared", record.verdict[Figure::FRICTION_OF_ARM] },
                                           { "reference", referenceName(record.friction.reference) } } :
                                     Json(std::optional<double>());
}

/// Writes the data of the page's figures.
void writeData(const std::string& directory, const RecordingComparison& comparison, const Parameters& parameters,
               const ComparisonRecord& record)
{
  writeCourse(directory + "/course.csv", comparison);
  writeFriction(directory, comparison);
  writeSpectrum(directory + "/spectrum.csv", comparison);
  writeTorsion(directory, comparison, parameters);
  writeTeeth(directory + "/teeth.csv", comparison, parameters);
  writeTwinStates(directory + "/twin_states.csv", record.twin_states);
  if (!comparison.evidence().assessor().baseline().bins().empty())
  {
    writeBaseline(directory + "/" + BASELINE_FILE, comparison.evidence().assessor().baseline(), false);
  }
}
}  // namespace

Json writeComparison(const std::string& directory, const RecordingComparison& comparison, const Parameters& parameters,
                     const ComparisonRecord& record)
{
  if (!directory.empty())
  {
    writeData(directory, comparison, parameters, record);
  }
  const MotionReach& reach = comparison.evidence().reach();
  Json orders;
  const LineOrders tracked = trackedOrders(parameters.gear, parameters.bearing);
  for (std::size_t i = 0; i < FIRST_LOADED; ++i)
  {
    const std::string name = indicatorName(amplitudeIndex(LineSignal::MOTOR_TORQUE, i));
    orders[name.substr(std::string("torque_").size())] = tracked[i];
  }
  const Json all{ { "recording", record.recording },
                  { "joint", record.joint },
                  { "made_with", record.made_with },
                  { "verdict", verdictJson(record.verdict) },
                  { "contents", contentsJson(record.contents) },
                  { "reading",
                    { { "rows", reach.rows },
                      { "duration", record.found.duration },
                      { "unreadable_or_impossible", record.found.corrupt + reach.impossible },
                      { "repeated_or_out_of_order", record.found.refused },
                      { "temperatures_refused", record.found.refused_temperatures },
                      { "gaps", record.found.gaps },
                      { "least_delay", record.found.least_delay },
                      { "most_delay", record.found.most_delay } } },
                  { "motion",
                    { { "least_angle", reach.least_angle },
                      { "most_angle", reach.most_angle },
                      { "least_load", reach.least_load },
                      { "most_load", reach.most_load },
                      { "typical_load", comparison.evidence().typicalLoad() },
                      { "largest_load", comparison.evidence().largestLoad() } } },
                  { "current",
                    { { "measured_rms", comparison.evidence().currentRms() },
                      { "residual_rms", comparison.evidence().residualRms() } } },
                  { "temperature", comparison.evidence().temperature() },
                  { "temperature_source", temperatureSource(comparison.evidence()) },
                  { "friction_ratio", comparison.evidence().friction().ratio().value },
                  { "friction_deviation", frictionDeviation(record) },
                  { "friction_factor", factorJson(record) },
                  { "compliance_ratio", comparison.evidence().torsion().compliance() },
                  { "line_orders", orders },
                  { "highest_order", record.verdict[Figure::HIGHEST_ORDER] },
                  { "windows_assessed", comparison.evidence().assessedWindows() },
                  { "health", healthJson(comparison) } };
  if (!directory.empty())
  {
    writeTextFile(directory + "/" + COMPARISON_FILE, all.dump() + "\n");
  }
  return all;
}
}  // namespace hjt
