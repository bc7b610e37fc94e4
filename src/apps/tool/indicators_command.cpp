// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "apps/common/exit_code.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/report.hpp"
#include "apps/common/run_summary.hpp"
#include "apps/common/text_table.hpp"
#include "apps/tool/recorded_signals.hpp"

#include "base/number_text.hpp"
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
struct IndicatorsOptions : SignalOptions
{
  std::vector<std::string> models;  // none, or one for each recording
  std::string baseline;
  std::string save_baseline;
  std::string out;
  bool carry{};    ///< the reference is of another motion
  bool windows{};  ///< the recordings hold the windows' indicators, not the signals
};

/// One window and what was made of it.
struct WindowResult
{
  std::string recording;
  SignalIndicators indicators;
  Deviations deviations;
  WindowResidual residual;
  Assessment assessment;
};

const char* stateName(AssessmentState state)
{
  constexpr std::array NAMES{ "waiting", "learning", "assessed", "no reference" };
  return NAMES[static_cast<std::size_t>(state)];
}

/// All windows of a recording of signals.
std::vector<SignalIndicators> readWindows(const std::string& path, const SignalSource& source,
                                          const Parameters& parameters, std::uint64_t& refused)
{
  SignalMonitor monitor(parameters);
  std::vector<SignalIndicators> windows;
  const InterruptScope interrupts;
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
  const std::vector<Column<Evidence>> columns{ { "indicator",
                                                 [](const Evidence& item) { return indicatorName(item.indicator); } },
                                               { "value", &Evidence::value },
                                               { "expected", &Evidence::expected },
                                               { "score", &Evidence::score } };
  const std::vector<Evidence> evidence(
      assessment.evidence.begin(),
      assessment.evidence.begin() + static_cast<std::ptrdiff_t>(assessment.evidence_count));
  Json alternatives{ std::initializer_list<Json::Member>{} };
  for (std::size_t i = 0; i < assessment.alternative_count; ++i)
  {
    alternatives[causeName(assessment.alternatives[i].cause)] = assessment.alternatives[i].confidence;
  }
  return { { "state", stateName(assessment.state) },
           { "level", levelName(assessment.level) },
           { "cause", causeName(assessment.cause) },
           { "confidence", assessment.confidence },
           { "severity", assessment.severity },
           { "severity_deviation", assessment.severity_deviation },
           { "alternatives", alternatives },
           { "largest_score", assessment.largest_score },
           { "evidence", Table(columns, evidence).rows() } };
}

/// Of a window, for documents and files alike.
const std::vector<Column<WindowResult>> POINT_COLUMNS{
  { "time", [](const WindowResult& window) { return toSeconds(window.indicators.stamp); } },
  { "turns", [](const WindowResult& window) { return window.indicators.turns; } },
  { "speed", [](const WindowResult& window) { return window.indicators.point.speed; } },
  { "direction", [](const WindowResult& window) { return window.indicators.point.direction; } },
  { "load", [](const WindowResult& window) { return window.indicators.point.load; } },
  { "load_constant", [](const WindowResult& window) { return window.indicators.point.load_constant; } },
  { "load_sine", [](const WindowResult& window) { return window.indicators.point.load_sine; } },
  { "load_cosine", [](const WindowResult& window) { return window.indicators.point.load_cosine; } },
  { "inertia", [](const WindowResult& window) { return window.indicators.point.inertia; } },
  { "temperature", [](const WindowResult& window) { return window.indicators.point.temperature; } }
};

/// What `value` gives for each indicator, by its name.
template <class Value>
Json byIndicator(const Value& value)
{
  Json json;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    json[indicatorName(i)] = value(i);
  }
  return json;
}

/// Sound value, difference from it, own variance, what goes with each common cause; null: not compared.
Json residualJson(const WindowResult& window)
{
  return byIndicator(
      [&](std::size_t i)
      {
        const WindowResidual& residual = window.residual;
        std::vector<double> numbers{ residual.sound[i], residual.difference[i], residual.own[i] };
        numbers.insert(numbers.end(), residual.common[i].begin(), residual.common[i].end());
        return residual.own[i] > 0.0 ? Json(numbers) : Json();
      });
}

std::vector<Column<WindowResult>> documentColumns()
{
  using W = const WindowResult&;
  std::vector<Column<WindowResult>> columns = POINT_COLUMNS;
  columns.insert(columns.begin(), { "recording", &WindowResult::recording });
  columns.push_back({ "indicators", [](W window)
                      { return byIndicator([&](std::size_t i) { return window.indicators.values[i]; }); } });
  columns.push_back(
      { "scores", [](W window) { return byIndicator([&](std::size_t i) { return window.deviations[i].score; }); } });
  columns.push_back({ "residual", residualJson });
  columns.push_back({ "freedom", [](const WindowResult& window) { return window.residual.freedom; } });
  columns.push_back({ "averaged", [](const WindowResult& window) { return window.residual.windows; } });
  columns.push_back({ "assessment", [](const WindowResult& window) { return toJson(window.assessment); } });
  return columns;
}

std::vector<Column<WindowResult>> fileColumns()
{
  std::vector<Column<WindowResult>> columns = POINT_COLUMNS;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    columns.push_back({ indicatorName(i), [i](const WindowResult& window) { return window.indicators.values[i]; } });
  }
  columns.push_back({ "level", [](const WindowResult& window) { return static_cast<int>(window.assessment.level); } });
  columns.push_back({ "cause", [](const WindowResult& window) { return static_cast<int>(window.assessment.cause); } });
  columns.push_back({ "confidence", [](const WindowResult& window) { return window.assessment.confidence; } });
  columns.push_back({ "severity", [](const WindowResult& window) { return window.assessment.severity; } });
  columns.push_back(
      { "severity_deviation", [](const WindowResult& window) { return window.assessment.severity_deviation; } });
  columns.push_back({ "largest_score", [](const WindowResult& window) { return window.assessment.largest_score; } });
  return columns;
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
      std::printf(" %14s %8s", shortNumber(deviation.expected).c_str(), fixedText(deviation.score, 2).c_str());
    }
    std::printf("\n");
  }
}

void printSummary(const std::vector<WindowResult>& windows)
{
  const WindowResult& last = windows.back();
  printTable(last);
  const Assessment& assessment = last.assessment;
  const bool judged = assessment.state == AssessmentState::ASSESSED;
  std::vector<ReportLine> lines{ { "", "windows", windows.size() },
                                 { "", "turns in the last", last.indicators.turns },
                                 { "", "motor speed in it", last.indicators.point.speed, "rad/s" },
                                 { "", "state", stateName(assessment.state) },
                                 { "", "level", judged ? levelName(assessment.level) : "not judged" } };
  if (assessment.level != HealthLevel::OK)
  {
    lines.push_back({ "", "most likely cause", causeName(assessment.cause) });
    lines.push_back({ "", "confidence", assessment.confidence });
    lines.push_back({ "", "severity", assessment.severity });
    lines.push_back({ "", "its standard deviation", assessment.severity_deviation });
  }
  printReport(false, lines);
}

/// All windows of recording `index`, less those of its model if there is one, which come into `model`.
std::vector<SignalIndicators> readRecording(std::size_t index, const IndicatorsOptions& options,
                                            const Parameters& parameters, std::vector<SignalIndicators>& model)
{
  const std::string published = options.joint_namespace + "/" + topics::INDICATORS;
  std::uint64_t refused = 0;
  const auto read = [&](const std::string& path, const SignalSource& source, std::uint64_t& passed_over)
  {
    return options.windows ? readPublishedWindows(path, published) : readWindows(path, source, parameters, passed_over);
  };
  std::vector<SignalIndicators> measured = read(options.recordings[index], options.source, refused);
  if (!options.models.empty())
  {
    SignalSource model_source;
    model_source.joint = options.source.joint;
    model_source.states_topic = options.joint_namespace + "/" + topics::JOINT_STATES;
    model_source.load_topic = options.joint_namespace + "/" + topics::LOAD;
    std::uint64_t model_refused = 0;
    model = read(options.models[index], model_source, model_refused);
    measured.resize(std::min(measured.size(), model.size()));
    for (std::size_t i = 0; i < measured.size(); ++i)
    {
      measured[i] = difference(measured[i], model[i]);
    }
  }
  warn(refused, "samples without an angle, a torque or progress in time passed over");
  return measured;
}

int run(const IndicatorsOptions& given)
{
  IndicatorsOptions options = given;
  const Parameters parameters = loadParameters(options);
  options.source = signalSource(options, parameters);
  for (const std::string& file : { options.out, options.save_baseline })
  {
    requireWritable(file, options.force, options.recordings.front());
  }
  const bool less_model = !options.models.empty();
  if (less_model && options.models.size() != options.recordings.size())
  {
    throw InputError("--model was given " + std::to_string(options.models.size()) + " times for " +
                     std::to_string(options.recordings.size()) +
                     " recordings; it takes the twin's own recording of each, in their order");
  }
  Assessor assessor(parameters);
  if (!options.baseline.empty())
  {
    assessor.setReference(readBaseline(options.baseline, parameters, less_model), options.carry);
  }
  std::vector<WindowResult> windows;
  for (std::size_t index = 0; index < options.recordings.size(); ++index)
  {
    const std::string& recording = options.recordings[index];
    if (!options.baseline.empty())
    {
      assessor.reset();  // each is judged for itself
    }
    std::vector<SignalIndicators> model;
    const std::vector<SignalIndicators> measured = readRecording(index, options, parameters, model);
    if (measured.empty())
    {
      std::cerr << "joint_twin: " << recording << " holds no whole window of steady motion\n";
    }
    for (std::size_t i = 0; i < measured.size(); ++i)
    {
      const Assessment assessment = assessor.update(measured[i], model.empty() ? nullptr : &model[i]);
      windows.push_back({ recording, measured[i], assessor.deviations(), assessor.baseline().residual(), assessment });
    }
  }
  if (windows.empty())
  {
    throw InputError(options.recordings.front() + " is too short for one window (indicators.window_turns = " +
                     shortNumber(parameters.indicators.window_turns) + " motor turns, indicators.window_time = " +
                     shortNumber(parameters.indicators.window_time) + " s)");
  }
  writeTable(options.out, fileColumns(), windows);
  if (!options.save_baseline.empty())
  {
    writeBaseline(options.save_baseline, assessor.baseline(), less_model);
  }
  if (options.json)
  {
    printReport(true, { { "threshold", "", assessor.baseline().threshold() },
                        { "windows", "", Table(documentColumns(), windows).rows() },
                        { "assessment", "", toJson(windows.back().assessment) } });
  }
  else
  {
    printSummary(windows);
  }
  return interruptSignal() != 0 ? EXIT_BY_SIGNAL + interruptSignal() : static_cast<int>(EXIT_DONE);
}

void declare(Command& command, IndicatorsOptions& options)
{
  addSignalOptions(command, options);
  command
      .add("--model", options.models,
           "the twin's own recording of the same run, whose indicators are subtracted; once for each recording, in "
           "their order")
      .type("FILE.csv|FILE.bag|FILE.h5")
      .check(wrongSignalFile);
  command.flag("--windows", options.windows,
               "the recordings are bags with NAMESPACE/indicators: windows that were published, not signals");
  command.add("--baseline", options.baseline, "healthy reference; default: learned from the first windows")
      .type("FILE.yaml");
  command
      .flag("--carry", options.carry,
            "the reference is of another motion to and fro, a check-up: carried to this one by the models")
      .needs("--baseline")
      .needs("--model");
  command.add("--save-baseline", options.save_baseline, "writes the reference that was learned").type("FILE.yaml");
  command.add("--out", options.out, "CSV with a row per window").type("FILE.csv");
  addCommonOptions(command, options);
}

const Subcommand INDICATORS{
  Subject::RECORDING, "indicators",
  "health indicators and assessment of a recording, from encoders and torque or current alone", declare, run
};
}  // namespace
}  // namespace hjt
