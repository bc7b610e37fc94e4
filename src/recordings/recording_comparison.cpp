// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recording_comparison.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "bags/recorded_messages.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/health/signal_indicators.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "harmonic_joint_twin/statics/torsion_loop.hpp"
#include "health/baseline_file.hpp"
#include "messages/conversions.hpp"
#include "messages/topics.hpp"
#include "recordings/arm_recording.hpp"
#include "tracking/sound_joint.hpp"

namespace hjt
{
namespace
{
constexpr const char* ANGLE_AND_CURRENT = "angle and current of the joint";
constexpr const char* MOTOR_ANGLE = "angle of the motor, for torsion, stiffness and kinematic error";
constexpr const char* LOAD = "load at the output; if missing, weight and inertia as configured";
constexpr const char* TEMPERATURE = "temperature of the drive; if missing, as configured";
constexpr const char* TWIN = "angle and speed of a twin that ran beside the robot";

const auto NO_PROGRESS = [](double) {};

const std::vector<Column<JudgedWindow>> WINDOW_COLUMNS{
  { "time", [](const JudgedWindow& window) { return 1e-9 * static_cast<double>(window.indicators.stamp); } },
  { "speed", [](const JudgedWindow& window) { return window.indicators.point.speed; } },
  { "load", [](const JudgedWindow& window) { return window.indicators.point.load; } },
  { "level", [](const JudgedWindow& window) { return static_cast<int>(window.assessment.level); } },
  { "cause", [](const JudgedWindow& window) { return static_cast<int>(window.assessment.cause); } },
  { "confidence", [](const JudgedWindow& window) { return window.assessment.confidence; } },
  { "largest_score", [](const JudgedWindow& window) { return window.assessment.largest_score; } }
};

/// One recorded state of a twin that ran while the bag was recorded.
struct TwinState
{
  double time{};           ///< time since the first row of the telemetry [s]
  double position{};       ///< angle of the joint [rad]
  double velocity{};       ///< speed of the joint [rad/s]
  double motor_current{};  ///< current of the motor [A]
};

/// Contents of the recording. `twin_topic` is the topic of a twin that ran beside the robot. @throws InputError if the
/// file cannot be read.
RecordingContents readContents(const MotionSource& source, const std::string& twin_topic, const MotionFindings& found,
                               const MotionReach& reach)
{
  const bool has_load = found.has_load;
  const std::uint64_t temperature_rows = reach.temperature_rows;
  RecordingContents contents;
  if (isCsv(source))
  {
    const std::string n = "_" + std::to_string(source.csv_joint);
    contents.lines = { { "timestamp, actual_q" + n + ", actual_current" + n, ANGLE_AND_CURRENT, found.rows, true },
                       { "target_moment" + n, LOAD, has_load ? found.rows : 0, has_load },
                       { "joint_temperatures" + n, TEMPERATURE, temperature_rows, temperature_rows > 0 } };
    return contents;
  }
  const std::unique_ptr<RecordedMessages> recording = RecordedMessages::open(source.path);
  const std::uint64_t loads = recording->messagesOn(source.load_topic);
  const std::uint64_t twins = twin_topic == source.topic ? 0 : recording->messagesOn(twin_topic);
  contents.lines = {
    { source.topic, ANGLE_AND_CURRENT, found.rows, true },
    { source.topic + ": " + JointNames(source.joint).motor, MOTOR_ANGLE, reach.motor_rows, reach.motor_rows > 0 },
    { source.load_topic, LOAD, loads, loads > 0 },
    { "sensor_msgs/Temperature of " + source.joint, TEMPERATURE, temperature_rows, temperature_rows > 0 }
  };
  if (twin_topic != source.topic)
  {
    contents.lines.push_back({ twin_topic, TWIN, twins, twins > 0 });
  }
  recording->visit(
      { source.topic }, false,
      [&](const RecordedMessage& message)
      {
        contents.joints = message.state == nullptr ? contents.joints : message.state->name;
        return message.state == nullptr;
      },
      NO_PROGRESS);
  const std::set<std::string> used{ source.topic, source.load_topic, twin_topic };
  std::set<std::string> others;
  for (const auto& [name, topic] : recording->topics())
  {
    const bool is_temperature = temperature_rows > 0 && topic.type == TEMPERATURE_TYPE;
    if (!is_temperature && used.count(name) == 0)
    {
      others.insert(name);
    }
  }
  contents.other_topics.assign(others.begin(), others.end());
  return contents;
}

/// One indicator of the worst window, for the table of the page.
struct HealthRow
{
  std::size_t indicator{};
  double value{};
  Deviation deviation;
};

Json healthJson(const JointEvidence& evidence)
{
  std::vector<HealthRow> rows;
  for (std::size_t i = 0; evidence.worst() && i < INDICATOR_COUNT; ++i)
  {
    const JudgedWindow& window = *evidence.worst();
    if (std::isfinite(window.indicators.values[i]) && std::isfinite(window.deviations[i].score))
    {
      rows.push_back({ i, window.indicators.values[i], window.deviations[i] });
    }
  }
  const double threshold = evidence.assessor().baseline().threshold();
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

/// The verdict as JSON, with everything that a page shows of it.
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

/// Standard deviation of the joint's friction from its scatter, over the friction [-]. NaN if the friction was not
/// judged, because such a friction is no reference.
double frictionDeviation(const ComparedJoint& compared)
{
  return compared.friction && compared.friction->isJudged() ? compared.friction->scatter :
                                                              std::numeric_limits<double>::quiet_NaN();
}

/// Friction factor divided by the arm's common factor, as JSON; null if the friction is not judged.
Json factorJson(const ComparedJoint& compared)
{
  const Verdict& verdict = compared.verdict;
  return compared.friction ? Json{ { "value", verdict.friction.factor },
                                   { "low", verdict.friction.lower },
                                   { "high", verdict.friction.upper },
                                   { "lowest_sound", verdict[Figure::FRICTION_LOWEST] },
                                   { "highest_sound", verdict[Figure::FRICTION_HIGHEST] },
                                   { "shared", verdict[Figure::FRICTION_OF_ARM] },
                                   { "reference", referenceName(compared.friction->reference) } } :
                             Json();
}
}  // namespace

RecordingComparison::RecordingComparison(const ArmRecording& recording, std::size_t joint, const std::string& directory,
                                         SoundJoint sound)
  : AssessedJoint(recording.parameters(joint), recording.loadOrigin(), std::move(sound),
                  !recording.options().identified.empty())
  , recording_(recording)
  , joint_(joint)
  , directory_(directory)
  , twin_topic_(recording.twinNamespace(joint) + "/" + topics::JOINT_STATES)
  , spectrum_(evidence().ratio())
{
  if (!directory.empty())
  {
    windows_.emplace(file("windows.csv"), WINDOW_COLUMNS);
  }
}

JointEvidence::Row RecordingComparison::update(const MotionSample& sample)
{
  const JointEvidence::Row taken = AssessedJoint::update(sample);
  if (taken == JointEvidence::Row::IMPOSSIBLE)
  {
    return taken;
  }
  const ComparedRow row{ sample, evidence().predicted() };
  course_.add(row);
  if (taken != JointEvidence::Row::TOUCHED && std::abs(sample.velocity) > FrictionPoints::SLOWEST &&
      row.predicted.tellsFriction())
  {
    spectrum_.add(sample.position, sample.velocity, row.residual());
  }
  if (taken == JointEvidence::Row::WINDOW && windows_)
  {
    const Assessor& assessor = evidence().assessor();
    windows_->write({ evidence().indicators(), assessor.deviations(), assessor.assessment() });
  }
  return taken;
}

ComparedJoint RecordingComparison::write(const MotionFindings& found, const JointContext& context)
{
  const MotionReach& reach = evidence().reach();
  ComparedJoint compared;
  if (recording_.isFile())
  {
    compared.contents = readContents(recording_.source(joint_), twin_topic_, found, reach);
  }
  compared.verdict = judge(evidence(), context);
  if (compared.verdict.findings.front().level != VerdictLevel::NOT_JUDGED)
  {
    compared.friction = frictionFactor(evidence(), context);
  }
  compared.contact = reach.touched_rows > 0 ? sentence(contactText(evidence().contact().largest())) : std::string();
  compared.temperature = evidence().temperature();
  compared.temperature_source = temperatureSource(evidence());
  compared.rows = reach.rows;
  compared.current_rms = evidence().currentRms();
  compared.residual_rms = evidence().residualRms();
  if (windows_)
  {
    windows_->close();
    writeData(found);
  }
  compared.document = documentOf(found, compared);
  if (!directory_.empty())
  {
    writeTextFile(file(COMPARISON_FILE), compared.document.dump() + "\n");
  }
  return compared;
}

void RecordingComparison::writeFriction() const
{
  const std::vector<Column<FrictionPoint>> columns{ { "speed", &FrictionPoint::speed },
                                                    { "measured", &FrictionPoint::measured },
                                                    { "deviation", &FrictionPoint::deviation },
                                                    { "twin", &FrictionPoint::twin },
                                                    { "rows", &FrictionPoint::rows } };
  const std::vector<FrictionPoint> points = evidence().friction().points();
  writeTable(file(FRICTION_FILE), columns, points);
  double fastest = 1.0;
  for (const FrictionPoint& point : points)
  {
    fastest = std::max(fastest, std::abs(point.speed));
  }
  constexpr int STEPS = 100;
  CsvWriter curve(file("friction_twin.csv"), { "speed", "at_typical_load", "at_largest_load" });
  for (int i = 1; i <= STEPS; ++i)
  {
    const double speed = 1.1 * fastest * i / STEPS;
    const auto at = [&](double load) { return evidence().twin().frictionAt(speed, load, evidence().temperature()); };
    curve.writeRow({ speed, at(evidence().typicalLoad()), at(evidence().largestLoad()) });
  }
  curve.close();
}

void RecordingComparison::writeTorsion() const
{
  if (evidence().torsion().rows() == 0)
  {
    return;
  }
  const std::vector<Column<TorsionMean>> columns{ { "torque", &TorsionMean::torque },
                                                  { "forward", &TorsionMean::forward },
                                                  { "backward", &TorsionMean::backward } };
  const std::vector<TorsionMean> means = evidence().torsion().means();
  writeTable(file("torsion.csv"), columns, means);
  double largest = 0.0;
  for (const TorsionMean& mean : means)
  {
    largest = std::max(largest, std::abs(mean.torque));
  }
  constexpr int STEPS = 60;
  const double lost_motion = parameters().indicators.lost_motion_torque;
  const TorsionLoop loop = analyseTorsionLoop(parameters(), std::max(largest, 2.0 * lost_motion), lost_motion, STEPS);
  const std::vector<Column<TorsionPoint>> curve{ { "torque", &TorsionPoint::torque },
                                                 { "torsion", &TorsionPoint::output_angle } };
  writeTable(file("torsion_twin.csv"), curve, loop.points);
}

/// Writes the twin's forces on every tooth under the typical and the largest load of the recording.
void RecordingComparison::writeTeeth() const
{
  const std::vector<StiffnessRow> rows =
      analyseStiffness(parameters(), 0.0, { evidence().typicalLoad(), evidence().largestLoad() });
  CsvWriter csv(file("teeth.csv"),
                { "x", "y", "wave_generator_typical", "mesh_typical", "wave_generator_largest", "mesh_largest" });
  const ToothTable& typical = rows[0].teeth;
  const ToothTable& largest = rows[1].teeth;
  for (std::size_t i = 0; i < typical.tooth_x.size(); ++i)
  {
    csv.writeRow({ typical.tooth_x[i], typical.tooth_y[i], typical.wave_generator_force[i], typical.mesh_force[i],
                   largest.wave_generator_force[i], largest.mesh_force[i] });
  }
  csv.close();
}

/// Writes the recorded states of a twin, if they are on another topic of the recording than the telemetry.
void RecordingComparison::writeTwinStates(double start) const
{
  const MotionSource source = recording_.source(joint_);
  Decimated<TwinState> states;
  if (isCsv(source) || twin_topic_ == source.topic)
  {
    return;
  }
  const std::unique_ptr<RecordedMessages> recording = RecordedMessages::open(source.path);
  if (recording->messagesOn(twin_topic_) == 0)
  {
    return;
  }
  const JointNames names(source.joint);
  recording->visit(
      { twin_topic_ }, false,
      [&](const RecordedMessage& message)
      {
        if (message.state == nullptr)
        {
          return true;
        }
        const sensor_msgs::JointState& state = *message.state;
        const std::size_t joint = placeOf(state, names.joint);
        const std::size_t motor = placeOf(state, names.motor);
        if (joint < std::min(state.position.size(), state.velocity.size()) && motor < state.effort.size())
        {
          states.add({ state.header.stamp.toSec() - start, state.position[joint], state.velocity[joint],
                       state.effort[motor] * source.current_per_motor_torque });
        }
        return true;
      },
      NO_PROGRESS);
  if (!states.rows().empty())
  {
    const std::vector<Column<TwinState>> columns{ { "time", &TwinState::time },
                                                  { "position", &TwinState::position },
                                                  { "velocity", &TwinState::velocity },
                                                  { "motor_current", &TwinState::motor_current } };
    writeTable(file("twin_states.csv"), columns, states.rows());
  }
}

/// Writes the data of the page's figures.
void RecordingComparison::writeData(const MotionFindings& found) const
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
  writeTable(file("course.csv"), columns, course_.rows());
  writeFriction();
  const std::vector<Column<SpectrumLine>> lines{ { "order", &SpectrumLine::order },
                                                 { "forward", &SpectrumLine::forward },
                                                 { "backward", &SpectrumLine::backward } };
  writeTable(file("spectrum.csv"), lines, spectrum_.lines());
  writeTorsion();
  writeTeeth();
  if (recording_.isFile())
  {
    writeTwinStates(toSeconds(found.start));
  }
  if (!evidence().assessor().baseline().bins().empty())
  {
    writeBaseline(file(BASELINE_FILE), evidence().assessor().baseline(), false);
  }
}

Json RecordingComparison::documentOf(const MotionFindings& found, const ComparedJoint& compared) const
{
  const MotionReach& reach = evidence().reach();
  Json orders;
  const LineOrders tracked = trackedOrders(parameters().gear, parameters().bearing);
  for (std::size_t i = 0; i < FIRST_LOADED; ++i)
  {
    const std::string name = indicatorName(amplitudeIndex(LineSignal::MOTOR_TORQUE, i));
    orders[name.substr(std::string("torque_").size())] = tracked[i];
  }
  const MotionSource source = recording_.source(joint_);
  return { { "recording", source.path },
           { "joint", source.joint },
           { "made_with", MADE_WITH },
           { "verdict", verdictJson(compared.verdict) },
           { "contents", contentsJson(compared.contents) },
           { "reading",
             { { "rows", reach.rows },
               { "duration", found.duration },
               { "unreadable_or_impossible", found.corrupt + reach.impossible },
               { "repeated_or_out_of_order", found.refused },
               { "temperatures_refused", found.refused_temperatures },
               { "gaps", found.gaps },
               { "least_delay", found.least_delay },
               { "most_delay", found.most_delay } } },
           { "motion",
             { { "least_angle", reach.least_angle },
               { "most_angle", reach.most_angle },
               { "least_load", reach.least_load },
               { "most_load", reach.most_load },
               { "typical_load", evidence().typicalLoad() },
               { "largest_load", evidence().largestLoad() } } },
           { "current", { { "measured_rms", evidence().currentRms() }, { "residual_rms", evidence().residualRms() } } },
           { "temperature", evidence().temperature() },
           { "temperature_source", temperatureSource(evidence()) },
           { "friction_ratio", evidence().friction().ratio().value },
           { "friction_deviation", frictionDeviation(compared) },
           { "friction_factor", factorJson(compared) },
           { "compliance_ratio", evidence().torsion().compliance() },
           { "line_orders", orders },
           { "highest_order", compared.verdict[Figure::HIGHEST_ORDER] },
           { "windows_assessed", evidence().assessedWindows() },
           { "health", healthJson(evidence()) } };
}

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
}  // namespace hjt
