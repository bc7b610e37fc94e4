// SPDX-License-Identifier: BSD-3-Clause
#include "apps/compare/comparison_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "apps/common/output_file.hpp"

#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/health/tracked_lines.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "harmonic_joint_twin/statics/torsion_loop.hpp"
#include "health/baseline_file.hpp"
#include "tracking/friction_map.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

Json numberOrNull(double value)
{
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

void writeCourse(const std::string& path, const RecordingComparison& comparison)
{
  CsvWriter csv(path, { "time", "position", "velocity", "load", "current_measured", "current_predicted", "current_band",
                        "friction_torque" });
  for (const ComparedRow& row : comparison.course().rows())
  {
    const MotionSample& m = row.measured;
    csv.writeRow({ m.time, m.position, m.velocity, m.load, m.current, row.predicted.current, row.predicted.band,
                   row.predicted.friction_torque });
  }
  csv.close();
}

void writeFriction(const std::string& directory, const RecordingComparison& comparison, const Parameters& parameters)
{
  CsvWriter csv(directory + "/friction.csv", { "speed", "measured", "deviation", "twin", "rows" });
  double fastest = 1.0;
  for (const FrictionPoint& point : comparison.friction().points())
  {
    csv.writeRow({ point.speed, point.measured, point.deviation, point.twin, static_cast<double>(point.rows) });
    fastest = std::max(fastest, std::abs(point.speed));
  }
  csv.close();
  constexpr int STEPS = 100;
  const FrictionMap map(parameters);
  const double ratio = comparison.ratio();
  CsvWriter curve(directory + "/friction_twin.csv", { "speed", "at_typical_load", "at_largest_load" });
  for (int i = 1; i <= STEPS; ++i)
  {
    const double speed = 1.1 * fastest * i / STEPS;
    const auto at = [&](double load)
    { return ratio * map.at(ratio * speed, load, parameters.input.temperature).sum(); };
    curve.writeRow({ speed, at(comparison.typicalLoad()), at(comparison.largestLoad()) });
  }
  curve.close();
}

void writeSpectrum(const std::string& path, const RecordingComparison& comparison)
{
  CsvWriter csv(path, { "order", "forward", "backward" });
  for (const SpectrumLine& line : comparison.spectrum().lines())
  {
    csv.writeRow({ line.order, line.forward, line.backward });
  }
  csv.close();
}

void writeTorsion(const std::string& directory, const RecordingComparison& comparison, const Parameters& parameters)
{
  if (comparison.torsion().rows() == 0)
  {
    return;
  }
  CsvWriter csv(directory + "/torsion.csv", { "torque", "forward", "backward" });
  double largest = 0.0;
  for (const TorsionMean& mean : comparison.torsion().means())
  {
    csv.writeRow({ mean.torque, mean.forward, mean.backward });
    largest = std::max(largest, std::abs(mean.torque));
  }
  csv.close();
  constexpr int STEPS = 60;
  const double lost_motion = parameters.indicators.lost_motion_torque;
  const TorsionLoop loop = analyseTorsionLoop(parameters, std::max(largest, 2.0 * lost_motion), lost_motion, STEPS);
  CsvWriter twin(directory + "/torsion_twin.csv", { "torque", "torsion" });
  for (const TorsionPoint& point : loop.points)
  {
    twin.writeRow({ point.torque, point.output_angle });
  }
  twin.close();
}

/// Every tooth of the twin's ring under the recording's typical and largest load.
void writeTeeth(const std::string& path, const RecordingComparison& comparison, const Parameters& parameters)
{
  const std::vector<StiffnessRow> rows =
      analyseStiffness(parameters, 0.0, { comparison.typicalLoad(), comparison.largestLoad() });
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

void writeTwinStates(const std::string& path, const Thinned<TwinState>& states)
{
  if (states.rows().empty())
  {
    return;
  }
  CsvWriter csv(path, { "time", "position", "velocity", "motor_current" });
  for (const TwinState& state : states.rows())
  {
    csv.writeRow({ state.time, state.position, state.velocity, state.motor_current });
  }
  csv.close();
}

Json healthJson(const RecordingComparison& comparison)
{
  Json table = Json::array();
  if (!comparison.worst())
  {
    return table;
  }
  const JudgedWindow& window = *comparison.worst();
  const double threshold = comparison.assessor().baseline().threshold();
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const Deviation& deviation = window.deviations[i];
    if (std::isfinite(window.indicators.values[i]) && std::isfinite(deviation.score))
    {
      table.push_back({ { "indicator", indicatorName(i) },
                        { "unit", indicatorUnit(i) },
                        { "value", window.indicators.values[i] },
                        { "reference", numberOrNull(deviation.expected) },
                        { "spread", numberOrNull(deviation.spread) },
                        { "score", deviation.score },
                        { "threshold", threshold } });
    }
  }
  return table;
}

Json contentsJson(const RecordingContents& contents)
{
  Json lines = Json::array();
  for (const ContentLine& line : contents.lines)
  {
    lines.push_back(
        { { "name", line.name }, { "gives", line.gives }, { "found", line.found }, { "messages", line.messages } });
  }
  return { { "topics", lines }, { "joints", contents.joints }, { "not_used", contents.other_topics } };
}

Json verdictJson(const Verdict& verdict)
{
  Json findings = Json::array();
  for (const Finding& finding : verdict.findings)
  {
    Json causes = Json::array();
    for (const Cause cause : finding.causes)
    {
      causes.push_back(causeName(cause));
    }
    findings.push_back({ { "title", finding.title },
                         { "level", finding.judged ? levelName(finding.level) : "NOT JUDGED" },
                         { "text", finding.text },
                         { "causes", causes } });
  }
  return { { "level", verdict.judged ? levelName(verdict.level) : "NOT JUDGED" },
           { "findings", findings },
           { "cannot_show", verdict.cannot_show } };
}
}  // namespace

SoundJoint readSoundJoint(const std::string& directory, const Parameters& parameters)
{
  SoundJoint sound;
  const std::string path = directory + "/" + COMPARISON_FILE;
  try
  {
    std::ifstream file(path);
    const Json record = Json::parse(file);
    const auto number = [&](const char* name)
    { return record.at(name).is_null() ? std::nan("") : record.at(name).get<double>(); };
    sound.own = { number("friction_ratio"), number("compliance_ratio") };
  }
  catch (const Json::exception& error)
  {
    throw InputError(path + " is no data of `joint_twin compare`: " + error.what());
  }
  const std::string baseline = directory + "/" + BASELINE_FILE;
  if (std::filesystem::exists(baseline))
  {
    sound.baseline = readBaseline(baseline, parameters);
  }
  return sound;
}

void writeComparison(const std::string& directory, const RecordingComparison& comparison, const Parameters& parameters,
                     const ComparisonRecord& record)
{
  writeCourse(directory + "/course.csv", comparison);
  writeFriction(directory, comparison, parameters);
  writeSpectrum(directory + "/spectrum.csv", comparison);
  writeTorsion(directory, comparison, parameters);
  writeTeeth(directory + "/teeth.csv", comparison, parameters);
  writeTwinStates(directory + "/twin_states.csv", record.twin_states);
  if (!comparison.assessor().baseline().bins().empty())
  {
    writeBaseline(directory + "/" + BASELINE_FILE, comparison.assessor().baseline());
  }

  const MotionReach& reach = comparison.reach();
  Json orders;
  const LineOrders tracked = trackedOrders(parameters.gear, parameters.bearing);
  for (std::size_t i = 0; i < LINE_COUNT; ++i)
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
                      { "gaps", record.found.gaps },
                      { "least_delay", record.found.least_delay },
                      { "most_delay", record.found.most_delay } } },
                  { "motion",
                    { { "least_angle", reach.least_angle },
                      { "most_angle", reach.most_angle },
                      { "least_load", reach.least_load },
                      { "most_load", reach.most_load },
                      { "typical_load", comparison.typicalLoad() },
                      { "largest_load", comparison.largestLoad() } } },
                  { "current",
                    { { "measured_rms", comparison.currentRms() }, { "residual_rms", comparison.residualRms() } } },
                  { "friction_ratio", numberOrNull(comparison.friction().ratio()) },
                  { "compliance_ratio", numberOrNull(comparison.torsion().compliance()) },
                  { "line_orders", orders },
                  { "highest_order", record.verdict.highest_order },
                  { "windows_assessed", comparison.assessedWindows() },
                  { "health", healthJson(comparison) } };
  const std::string path = directory + "/" + COMPARISON_FILE;
  writeTextFile(path, all.dump(2) + '\n');
}
}  // namespace hjt
