// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/indicators.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "output/output_file.hpp"
#include "output/report.hpp"
#include "recordings/recorded_windows.hpp"

#include "base/statistics.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "health/baseline_file.hpp"
#include "health/signal_monitor.hpp"
#include "health/signature_terms.hpp"

namespace hjt
{
namespace
{
/// Windows of a recording, with the source of the windows and of the parameters.
struct WindowSeries
{
  std::vector<SignalIndicators> windows;
  const char* origin{};  // source of the windows, as in WindowResult
  const char* parameters{};
};

/// Warns the user of uneven stamps. They make indicators wrong, because rates and accelerations are computed from the
/// stamps. A jitter of 0.05 ms at 2 kHz changed the stiffness K1 by 0.65 %, and a gap of 1 s changed K1 by 1.4 %.
void noticeSteps(std::vector<float> steps, const std::string& recording, const Watch& watch)
{
  constexpr double GAP = 10.0;     // least gap over the usual step; filters bridge shorter gaps [-]
  constexpr double JITTER = 0.05;  // least rms jitter of the steps that the user is told of, over the usual step [-]
  if (steps.size() < 2)
  {
    return;
  }
  const double usual = upperMedian(steps.begin(), steps.end());
  std::size_t gaps = 0;
  double longest = 0.0;
  double square = 0.0;
  for (const double step : steps)
  {
    const bool is_gap = step > GAP * usual;
    gaps += is_gap ? 1 : 0;
    longest = std::max(longest, step);
    square += is_gap ? 0.0 : std::pow(step - usual, 2);
  }
  const double jitter = std::sqrt(square / static_cast<double>(steps.size()));
  if (gaps > 0)
  {
    watch.notice(recording + ": " + std::to_string(gaps) + (gaps == 1 ? " gap" : " gaps") +
                 " between samples, the longest " + shortNumber(longest) + " s, where a step of " +
                 shortNumber(1e3 * usual) + " ms is usual; the indicators of windows with a gap are wrong");
  }
  if (jitter > JITTER * usual)
  {
    watch.notice(recording + ": steps between samples differ by " + shortNumber(std::round(1e5 * jitter) / 100.0) +
                 " ms rms from the usual " + shortNumber(1e3 * usual) +
                 " ms; give stamps of the measurement, not of the reception");
  }
}

/// Computes all windows of a recording of signals.
std::vector<SignalIndicators> readWindows(const std::string& recording, const SignalOptions& options,
                                          const Parameters& parameters, const Watch& watch)
{
  SignalMonitor monitor(parameters);
  monitor.seekBearingSlip(parameters);
  std::vector<SignalIndicators> windows;
  std::vector<float> steps;  // times between samples [s]
  std::int64_t last = 0;
  readSignals(recording, options, parameters,
              [&](const SignalSample& sample)
              {
                if (last != 0 && sample.stamp > last)
                {
                  steps.push_back(static_cast<float>(1e-9 * static_cast<double>(sample.stamp - last)));
                }
                last = sample.stamp;
                if (monitor.update(sample))
                {
                  windows.push_back(monitor.indicators());
                }
                return !watch.stopped();
              });
  noticeSteps(std::move(steps), recording, watch);
  if (monitor.refused() > 0)
  {
    watch.notice(
        recording + ": " + std::to_string(monitor.refused()) +
        " samples were ignored, because they have no angle, no torque or no later time than the sample before");
  }
  return windows;
}

/// All windows of one recording, either of the joint or of its twin.
WindowSeries readOne(const std::string& path, const SignalOptions& signals, const IndicatorsOptions& options)
{
  if (options.windows)
  {
    return { publishedWindows(path, options.joint_namespace + "/" + topics::INDICATORS), "published windows",
             "configuration" };
  }
  const RecordingParameters parameters = recordingParameters(signals, path);
  if (std::optional<std::vector<SignalIndicators>> windows = windowsOfRun(path, signals, parameters))
  {
    return { std::move(*windows), "windows of the run", parameters.origin };
  }
  return { readWindows(path, signals, parameters.values, options.watch), "signals", parameters.origin };
}

/// All windows of the recording with this `index`. If the recording has a model, that is, a recording of the twin, the
/// model's indicators are subtracted, and `model` gets the windows of the model.
WindowSeries readRecording(std::size_t index, const IndicatorsOptions& options, std::vector<SignalIndicators>& model)
{
  WindowSeries measured = readOne(options.recordings[index], options, options);
  if (!options.models.empty())
  {
    SignalOptions twin;
    static_cast<ConfigurationOptions&>(twin) = static_cast<const ConfigurationOptions&>(options);
    twin.joint_namespace = options.joint_namespace;
    twin.at_hand = options.at_hand;
    model = readOne(options.models[index], twin, options).windows;
    measured.windows.resize(std::min(measured.windows.size(), model.size()));
    for (std::size_t i = 0; i < measured.windows.size(); ++i)
    {
      measured.windows[i] = difference(measured.windows[i], model[i]);
    }
  }
  return measured;
}

bool isSound(const Assessment& assessment)
{
  return assessment.state == AssessmentState::ASSESSED && assessment.level == HealthLevel::OK;
}

/// Tells the user which recordings cannot be read. @throws InputError if no recording can be read.
void throwIfNoneIsRead(const AssessedWindows& found, const IndicatorsOptions& options)
{
  const std::size_t recordings = options.recordings.size();
  if (found.unread.size() == recordings)
  {
    const std::string& why = found.unread.front().why;
    throw InputError(recordings == 1 ? why :
                                       "none of " + std::to_string(recordings) + " recordings can be read: " + why);
  }
  for (const UnreadRecording& recording : found.unread)
  {
    options.watch.notice("not read: " + recording.why);
  }
}

/// Assesses every window of the readable recordings. @throws InputError if no recording can be read.
AssessedWindows assess(const IndicatorsOptions& options, Assessor& assessor)
{
  AssessedWindows found;
  for (std::size_t index = 0; index < options.recordings.size(); ++index)
  {
    const std::string& recording = options.recordings[index];
    std::vector<SignalIndicators> model;
    WindowSeries measured;
    try
    {
      measured = readRecording(index, options, model);
    }
    catch (const InputError& error)
    {
      found.unread.push_back({ recording, error.what() });
      continue;
    }
    if (!options.baseline.empty())
    {
      assessor.reset();  // each recording is judged by itself
    }
    ClosestAssessment judged;
    for (std::size_t i = 0; i < measured.windows.size(); ++i)
    {
      const Assessment assessment = assessor.update(measured.windows[i], model.empty() ? nullptr : &model[i]);
      judged.take(assessment);
      found.windows.push_back({ recording, measured.origin, measured.parameters, measured.windows[i],
                                assessor.deviations(), assessor.baseline().residual(), assessment });
    }
    if (!measured.windows.empty() && isSound(found.windows.back().assessment) &&
        !assessor.signatures().signatures.empty())
    {
      found.windows.back().seen_from = seenFrom(assessor, found.windows.back().indicators.point);
    }
    found.is_judged = found.is_judged || judged.isJudged();
    if (!options.baseline.empty() ? !judged.isJudged() : measured.windows.empty())
    {
      options.watch.notice("not judged: " + judged.whyNotJudged(recording));
    }
  }
  throwIfNoneIsRead(found, options);
  return found;
}

/// Warns the user if a cause was sought with signatures of a gear that is much stiffer or softer than the reference.
void noticeOtherGear(const std::vector<WindowResult>& windows, const Assessor& assessor, const std::string& signatures,
                     const Watch& watch)
{
  // Stiffness differs by a factor of at least 1.9 from one gear size to the next, but of at most 1.25 within one size.
  constexpr double ALIKE = 1.6;
  constexpr std::size_t K1 = indexOf(ScalarIndicator::TORSIONAL_STIFFNESS);
  const double theirs = assessor.signatures().sound[K1];
  for (const WindowResult& window : windows)
  {
    const double own = window.residual.sound[K1];
    if (window.assessment.state == AssessmentState::ASSESSED && window.assessment.level != HealthLevel::OK &&
        own > 0.0 && theirs > 0.0 && std::abs(std::log(own / theirs)) > std::log(ALIKE))
    {
      watch.notice("the cause is sought with signatures of another gear: torsional_stiffness is " +
                   shortNumber(std::round(theirs)) + " N.m/rad in " + signatures + ", " + shortNumber(std::round(own)) +
                   " in the reference; `joint_twin signatures` makes signatures of your gear");
      return;
    }
  }
}

void refuseWrongModels(const IndicatorsOptions& options)
{
  if (!options.models.empty() && options.models.size() != options.recordings.size())
  {
    throw InputError("--model was given " + std::to_string(options.models.size()) + " times for " +
                     std::to_string(options.recordings.size()) +
                     " recordings; give a recording of the twin for each recording, in the same order");
  }
}

/// Parameters of the first readable recording.
Parameters parametersOf(const IndicatorsOptions& options)
{
  for (auto recording = options.recordings.begin();; ++recording)
  {
    try
    {
      return recordingParameters(options, *recording).values;
    }
    catch (const InputError&)
    {
      if (std::next(recording) == options.recordings.end())
      {
        throw;
      }
    }
  }
}
}  // namespace

void addOptions(OptionTable& table, IndicatorsOptions& options)
{
  addSignalOptions(table, options);
  table
      .add("--model", options.models,
           "recording of the twin on the same path, whose indicators are subtracted; once for each recording, in "
           "the same order")
      .type("FILE.csv|FILE.bag|FILE.h5")
      .check(wrongSignalFile);
  table.flag("--windows", options.windows,
             "read published windows from the topic NAMESPACE/indicators of bags, in place of signals");
  table.add("--baseline", options.baseline, "reference of the sound drive; default: from the first windows")
      .type("FILE.yaml");
  table
      .flag("--carry", options.carry,
            "the reference is from another motion to and fro, best a check-up; the program subtracts the indicators "
            "of --model from it too")
      .needs("--baseline")
      .needs("--model");
  table.add("--save-baseline", options.save_baseline, "file for the learned reference").type("FILE.yaml");
  table.add("--out", options.out, "CSV file with a row for each window").type("FILE.csv");
  addOptions(table, options, options.force);
}

AssessedWindows indicators(const IndicatorsOptions& options)
{
  const Parameters parameters = parametersOf(options);
  for (const std::string& file : { options.out, options.save_baseline })
  {
    requireWritable(file, options.force, options.recordings.front());
  }
  refuseWrongModels(options);
  const bool less_model = !options.models.empty();
  Assessor assessor(parameters);
  if (!options.baseline.empty())
  {
    assessor.setReference(readBaseline(options.baseline, parameters, less_model), options.carry);
  }
  AssessedWindows found = assess(options, assessor);
  noticeOtherGear(found.windows, assessor, parameters.indicators.signatures, options.watch);
  found.threshold = assessor.baseline().threshold();
  if (found.windows.empty() && !options.watch.stopped())
  {
    throw InputError(
        (options.recordings.size() == 1 ? options.recordings.front() : "each recording") +
        " is too short for one window (indicators.window_turns = " + shortNumber(parameters.indicators.window_turns) +
        " motor turns, indicators.window_time = " + shortNumber(parameters.indicators.window_time) + " s)");
  }
  writeWindows(options.out, found.windows);
  if (!options.save_baseline.empty())
  {
    writeBaseline(options.save_baseline, assessor.baseline(), less_model);
  }
  return found;
}
}  // namespace hjt
