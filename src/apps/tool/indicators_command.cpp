// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <nlohmann/json.hpp>

#include "apps/common/configuration.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/text_table.hpp"
#include "apps/common/validators.hpp"
#include "apps/tool/commands.hpp"
#include "apps/tool/recorded_signals.hpp"

#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/health/assessment.hpp"
#include "health/baseline_file.hpp"
#include "health/signal_monitor.hpp"
#include "ros_io/bag_file.hpp"
#include "ros_io/conversions.hpp"
#include "ros_io/time.hpp"
#include "ros_io/topics.hpp"

namespace hjt
{
namespace
{
using Json = nlohmann::ordered_json;

struct IndicatorsOptions : CommonOptions
{
  std::vector<std::string> recordings;
  std::string model;
  std::string baseline;
  std::string save_baseline;
  std::string out;
  std::string joint_namespace{ DEFAULT_NAMESPACE };
  bool windows{};  ///< the recordings hold the windows' indicators, not the signals
  std::optional<std::string> states_topic;
  std::optional<std::string> load_topic;
  SignalSource source;
};

/// One window and what was made of it.
struct WindowResult
{
  std::string recording;
  SignalIndicators indicators;
  Deviations deviations;
  Assessment assessment;
};

const char* stateName(AssessmentState state)
{
  switch (state)
  {
    case AssessmentState::LEARNING:
      return "learning";
    case AssessmentState::ASSESSED:
      return "assessed";
    case AssessmentState::NO_REFERENCE:
      return "no reference";
    case AssessmentState::WAITING:
      break;
  }
  return "waiting";
}

Json numberOrNull(double value)
{
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// All windows of a recording of signals.
std::vector<SignalIndicators> readWindows(const std::string& path, const SignalSource& source,
                                          const Parameters& parameters, std::uint64_t& refused)
{
  SignalMonitor monitor(parameters);
  std::vector<SignalIndicators> windows;
  readSignals(path, source,
              [&](const SignalSample& sample)
              {
                if (monitor.update(sample))
                {
                  windows.push_back(monitor.indicators());
                }
                return interruptSignal() == 0;
              });
  refused = monitor.refused();
  return windows;
}

/// What was published of the windows while they were recorded; each message repeats the last window.
std::vector<SignalIndicators> readPublishedWindows(const std::string& path, const std::string& topic)
{
  rosbag::Bag bag;
  openForReading(bag, path);
  std::vector<SignalIndicators> windows;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic)))
  {
    const auto message = instance.instantiate<harmonic_joint_twin::Indicators>();
    if (message && message->windows > (windows.empty() ? 0 : windows.back().windows))
    {
      windows.push_back(readIndicators(*message));
    }
  }
  return windows;
}

Json toJson(const Assessment& assessment)
{
  Json evidence = Json::array();
  for (std::size_t i = 0; i < assessment.evidence_count; ++i)
  {
    const Evidence& item = assessment.evidence[i];
    evidence.push_back({ { "indicator", indicatorName(item.indicator) },
                         { "value", numberOrNull(item.value) },
                         { "expected", numberOrNull(item.expected) },
                         { "score", numberOrNull(item.score) } });
  }
  return { { "state", stateName(assessment.state) },      { "level", levelName(assessment.level) },
           { "cause", causeName(assessment.cause) },      { "confidence", assessment.confidence },
           { "largest_score", assessment.largest_score }, { "evidence", evidence } };
}

Json toJson(const WindowResult& window)
{
  Json values;
  Json scores;
  Json features;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    values[indicatorName(i)] = numberOrNull(window.indicators.values[i]);
    scores[indicatorName(i)] = numberOrNull(window.deviations[i].score);
  }
  const FeatureScores found = featureScores(window.deviations);
  for (std::size_t i = 0; i < FEATURE_COUNT; ++i)
  {
    features[featureName(static_cast<Feature>(i))] = found[i].compared ? Json(found[i].score) : Json(nullptr);
  }
  const OperatingPoint& point = window.indicators.point;
  return { { "recording", window.recording },
           { "time", toSeconds(window.indicators.stamp) },
           { "turns", window.indicators.turns },
           { "speed", point.speed },
           { "direction", point.direction },
           { "load", numberOrNull(point.load) },
           { "temperature", numberOrNull(point.temperature) },
           { "indicators", values },
           { "scores", scores },
           { "features", features },
           { "assessment", toJson(window.assessment) } };
}

void writeWindows(const std::string& path, const std::vector<WindowResult>& windows)
{
  std::vector<std::string> columns{ "time", "turns", "speed", "direction", "load", "temperature" };
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    columns.emplace_back(indicatorName(i));
  }
  columns.insert(columns.end(), { "level", "cause", "confidence", "largest_score" });
  CsvWriter csv(path, columns);
  for (const WindowResult& window : windows)
  {
    const SignalIndicators& indicators = window.indicators;
    const OperatingPoint& point = indicators.point;
    std::vector<double> row{
      toSeconds(indicators.stamp), indicators.turns, point.speed, point.direction, point.load, point.temperature
    };
    row.insert(row.end(), indicators.values.begin(), indicators.values.end());
    row.insert(row.end(), { static_cast<double>(window.assessment.level), static_cast<double>(window.assessment.cause),
                            window.assessment.confidence, window.assessment.largest_score });
    csv.writeRow(row);
  }
  csv.close();
}

void printTable(const WindowResult& window)
{
  std::printf("%-32s %14s %-10s %14s %8s\n", "indicator", "value", "unit", "healthy", "score");
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const double value = window.indicators.values[i];
    const Deviation& deviation = window.deviations[i];
    if (!std::isfinite(value))
    {
      continue;
    }
    std::printf("%-32s %14s %-10s", indicatorName(i), shortNumber(value).c_str(), indicatorUnit(i));
    if (std::isfinite(deviation.score))
    {
      std::printf(" %14s %8.2f", shortNumber(deviation.expected).c_str(), deviation.score);
    }
    std::printf("\n");
  }
}

void printSummary(const std::vector<WindowResult>& windows)
{
  const WindowResult& last = windows.back();
  printTable(last);
  const Assessment& assessment = last.assessment;
  std::vector<NamedValue> lines{ { "windows", std::to_string(windows.size()), "" },
                                 { "turns in the last", shortNumber(last.indicators.turns), "" },
                                 { "motor speed in it", shortNumber(last.indicators.point.speed), "rad/s" },
                                 { "state", stateName(assessment.state), "" },
                                 { "level", levelName(assessment.level), "" } };
  if (assessment.level != HealthLevel::OK)
  {
    lines.push_back({ "most likely cause", causeName(assessment.cause), "" });
    lines.push_back({ "confidence", shortNumber(assessment.confidence), "" });
  }
  printValues(lines);
}

/// All windows of a recording, less those of the model if there is one.
std::vector<SignalIndicators> readRecording(const std::string& path, const IndicatorsOptions& options,
                                            const Parameters& parameters)
{
  std::uint64_t refused = 0;
  std::vector<SignalIndicators> measured =
      options.windows ? readPublishedWindows(path, options.joint_namespace + "/" + topics::INDICATORS) :
                        readWindows(path, options.source, parameters, refused);
  if (!options.model.empty())
  {
    SignalSource model_source;
    model_source.joint = options.source.joint;
    model_source.states_topic = options.joint_namespace + "/" + topics::JOINT_STATES;
    model_source.load_topic = options.joint_namespace + "/" + topics::LOAD;
    std::uint64_t model_refused = 0;
    const std::vector<SignalIndicators> model = readWindows(options.model, model_source, parameters, model_refused);
    measured.resize(std::min(measured.size(), model.size()));
    for (std::size_t i = 0; i < measured.size(); ++i)
    {
      measured[i] = difference(measured[i], model[i]);
    }
  }
  if (refused > 0)
  {
    std::cerr << "joint_twin: " << refused << " samples without an angle, a torque or progress in time passed over\n";
  }
  return measured;
}

int run(IndicatorsOptions options)
{
  const Parameters parameters = loadParameters(options);
  options.source.joint = parameters.joint.name;
  options.source.states_topic = options.states_topic.value_or(options.joint_namespace + "/" + topics::JOINT_STATES);
  options.source.load_topic = options.load_topic.value_or(options.joint_namespace + "/" + topics::LOAD);
  for (const std::string& file : { options.out, options.save_baseline })
  {
    if (!file.empty())
    {
      requireWritable(file, options.force, options.recordings.front());
    }
  }
  Assessor assessor(parameters);
  if (!options.baseline.empty())
  {
    assessor.give(readBaseline(options.baseline, parameters));
  }
  std::vector<WindowResult> windows;
  for (const std::string& recording : options.recordings)
  {
    if (!options.baseline.empty())
    {
      assessor.reset();  // each is judged for itself
    }
    const std::vector<SignalIndicators> measured = readRecording(recording, options, parameters);
    if (measured.empty())
    {
      std::cerr << "joint_twin: " << recording << " holds no whole window of steady motion\n";
    }
    for (const SignalIndicators& indicators : measured)
    {
      const Assessment assessment = assessor.take(indicators);
      windows.push_back({ recording, indicators, assessor.deviations(), assessment });
    }
  }
  if (windows.empty())
  {
    throw InputError(options.recordings.front() + " is too short for one window (indicators.window_turns = " +
                     shortNumber(parameters.indicators.window_turns) + " motor turns, indicators.window_time = " +
                     shortNumber(parameters.indicators.window_time) + " s)");
  }
  if (!options.out.empty())
  {
    writeWindows(options.out, windows);
  }
  if (!options.save_baseline.empty())
  {
    writeBaseline(options.save_baseline, assessor.baseline());
  }
  if (options.json)
  {
    Json list = Json::array();
    for (const WindowResult& window : windows)
    {
      list.push_back(toJson(window));
    }
    std::cout << Json{
      { "threshold", assessor.baseline().threshold() },
      { "windows", list },
      { "assessment", toJson(windows.back().assessment) }
    }.dump(2) << '\n';
  }
  else
  {
    printSummary(windows);
  }
  return interruptSignal() != 0 ? EXIT_BY_SIGNAL + interruptSignal() : static_cast<int>(EXIT_DONE);
}

void addSourceOptions(CLI::App& command, IndicatorsOptions& options)
{
  SignalSource& source = options.source;
  const auto column = [&command](const char* name, std::string& field, const char* meaning)
  { command.add_option(name, field, meaning)->type_name("COLUMN")->capture_default_str(); };
  column("--time", source.time, "CSV: time [s]");
  column("--motor-torque", source.motor_torque, "CSV: motor torque, or current with --torque-scale");
  column("--motor-angle", source.motor_angle, "CSV: motor encoder [rad]");
  column("--output-angle", source.output_angle, "CSV: output encoder [rad]");
  column("--motor-velocity", source.motor_velocity, "CSV: motor speed [rad/s]; else differences of the angle");
  column("--load-torque", source.load_torque, "CSV: load torque at the output, > 0 resists positive motion [N.m]");
  column("--temperature", source.temperature, "CSV: temperature [degC]");
  command
      .add_option("--torque-scale", source.torque_scale,
                  "motor torque per unit of what is recorded for it [N.m], for a current: gain / ratio [N.m/A]")
      ->capture_default_str()
      ->check(FINITE);
  command
      .add_option("--states-topic", options.states_topic, "bag: JointState messages; default: NAMESPACE/joint_states")
      ->type_name("TOPIC");
  command.add_option("--load-topic", options.load_topic, "bag: load torque; default: NAMESPACE/load")
      ->type_name("TOPIC");
}
}  // namespace

void addIndicatorsCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<IndicatorsOptions>();
  auto* command = app.add_subcommand("indicators",
                                     "health indicators and assessment of a recording, from encoders and "
                                     "torque or current alone");
  command->add_option("recordings", options->recordings, "one recording, or several of the same joint")
      ->required()
      ->type_name("IN.csv|IN.bag")
      ->check(BAG_OR_CSV);
  command
      ->add_option("--model", options->model, "the twin's own recording of the same run: its indicators are taken off")
      ->type_name("FILE.csv|FILE.bag")
      ->check(BAG_OR_CSV);
  command->add_flag("--windows", options->windows,
                    "the recordings are bags with NAMESPACE/indicators: windows that were published, not signals");
  command->add_option("--baseline", options->baseline, "healthy reference; default: learned from the first windows")
      ->type_name("FILE.yaml");
  command->add_option("--save-baseline", options->save_baseline, "writes the reference that was learned")
      ->type_name("FILE.yaml");
  command->add_option("--out", options->out, "CSV with a row per window")->type_name("FILE.csv");
  addSourceOptions(*command, *options);
  addNamespaceOption(*command, options->joint_namespace);
  addCommonOptions(*command, *options);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}
}  // namespace hjt
