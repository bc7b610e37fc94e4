// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/remaining.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "output/output_file.hpp"
#include "recordings/indicators.hpp"
#include "recordings/recorded_windows.hpp"

#include "base/range.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "health/baseline_file.hpp"
#include "health/signal_monitor.hpp"
#include "life/duty_cycle.hpp"

namespace hjt
{
namespace
{
/// Adds the samples of a recording to the drive's use. Time steps of a second or more do not count as use.
class RecordedUse
{
public:
  RecordedUse(const Parameters& parameters, UsageHistory& use)
    : output_(parameters.output)
    , temperature_(parameters.input.temperature)
    , ratio_(nominalRatio(parameters.gear))
    , use_(use)
  {
  }

  void add(const SignalSample& sample)
  {
    constexpr double LONGEST = 1.0;  // shortest time step that does not count as use [s]
    const double seconds = last_ ? 1e-9 * static_cast<double>(sample.stamp - last_->stamp) : 0.0;
    const double speed = last_ ? std::abs(motorAngle(sample) - motorAngle(*last_)) / seconds : 0.0;
    const double torque = jointTorque(sample);
    if (seconds > 0.0 && seconds < LONGEST && std::isfinite(speed) && std::isfinite(torque))
    {
      use_.add({ seconds, speed, torque, std::isfinite(sample.temperature) ? sample.temperature : temperature_ });
    }
    last_ = std::isfinite(motorAngle(sample)) ? sample : last_;
  }

private:
  double motorAngle(const SignalSample& sample) const
  {
    return std::isfinite(sample.motor_angle) ? sample.motor_angle : ratio_ * sample.output_angle;
  }

  double jointTorque(const SignalSample& sample) const
  {
    if (!std::isfinite(sample.load_torque))
    {
      return ratio_ * sample.motor_torque;
    }
    const double weight = output_.gravity_torque != 0.0 ?
                              output_.gravity_torque * std::sin(sample.output_angle - output_.gravity_angle) :
                              0.0;
    return sample.load_torque + weight;
  }

  OutputParameters output_;
  double temperature_;  // temperature of samples without a measured one [degC]
  double ratio_;
  UsageHistory& use_;
  std::optional<SignalSample> last_;
};

/// The use `use`, scaled to a length of `hours` [h].
UsageHistory lasting(const UsageHistory& use, double hours, const LifeParameters& life)
{
  UsageHistory scaled(life);
  for (DutyPhase phase : use.duty().phases)
  {
    phase.duration *= hours / use.hours();
    scaled.add(phase);
  }
  return scaled;
}

/// Begins of bins of remaining hours [h], and the probability of the drive's end in each bin. The last bin is open.
Json densityJson(const RemainingHours& remaining)
{
  std::vector<double> hours(RemainingHours::BINS);
  for (std::size_t i = 0; i < hours.size(); ++i)
  {
    hours[i] = RemainingHours::edge(i);
  }
  return { { "hours", hours },
           { "probability", std::vector<double>(remaining.probability.begin(), remaining.probability.end()) } };
}

/// Probability of each cause of the drive's end, as JSON.
Json endJson(const RemainingHours& remaining)
{
  Json json;
  for (std::size_t i = 0; i < remaining.by_cause.size(); ++i)
  {
    json[nameOf(RemainingHours::CAUSES[i])] = remaining.by_cause[i];
  }
  return json;
}

/// Catalogue ratings of the run's gear, combined with the laws of ageing of the configuration. The laws of ageing of a
/// simulated drive are ignored, because nobody knows those of a real drive.
LifeParameters assumedLife(const RemainingOptions& options, const LifeParameters& of_run)
{
  ParameterMap map = defaultParameterMap(options);
  addOverlays(options, map);
  LifeParameters life = parseParameters(map).life;
  life.rated_torque = of_run.rated_torque;
  life.repeated_peak_torque = of_run.repeated_peak_torque;
  life.momentary_peak_torque = of_run.momentary_peak_torque;
  life.momentary_peak_cycles = of_run.momentary_peak_cycles;
  life.rated_speed = of_run.rated_speed;
  life.bearing_l10 = of_run.bearing_l10;
  life.bearing_l50 = of_run.bearing_l50;
  life.face_width = of_run.face_width;
  life.elastic_modulus = of_run.elastic_modulus;
  return life;
}

/// Last assessment and readings of wear of the drive, from the recordings.
struct Condition
{
  void take(const Assessor& assessor, const OperatingPoint& point)
  {
    if (!supersedes(assessor.assessment(), assessment))
    {
      return;
    }
    assessment = assessor.assessment();
    seen_from = assessment.level == HealthLevel::OK ? std::make_optional(seenFrom(assessor, point)) : std::nullopt;
  }

  Assessment assessment;  // latest assessment of a window that was compared; its state is WAITING if there is none
  std::optional<SeenFrom> seen_from;
  ReadWear read;
};

/// Hours of use of the drive when the recording with this number was made [h].
double hoursOf(const RemainingOptions& options, std::size_t recording, const UsageHistory& use)
{
  if (options.hours.empty())
  {
    return use.hours();
  }
  return options.hours[options.hours.size() > 1 ? recording : 0];
}

/// Reads the drive's use from the recordings, unless the options have a duty cycle. With a reference, also reads the
/// wear and the latest assessment. @throws InputError if there is a reference, but no recording can be judged.
Condition readRecordings(const RemainingOptions& options, Assessor& assessor, UsageHistory& use)
{
  const bool is_assessed = !options.baseline.empty();
  Condition condition;
  bool any = false;
  std::string why_not;
  for (std::size_t i = 0; i < options.recordings.size(); ++i)
  {
    const std::string& recording = options.recordings[i];
    WearReading wear;
    const RecordingParameters parameters = recordingParameters(options, recording);
    ClosestAssessment judged;
    assessor.reset();
    const auto judge = [&](const SignalIndicators& window)
    {
      judged.take(assessor.update(window));
      condition.take(assessor, window.point);
      const WearReading read = readWear(assessor.baseline().residual(), window.point, assessor.signatures());
      wear = read.is_read ? read : wear;
    };
    const std::optional<std::vector<SignalIndicators>> windows =
        is_assessed ? windowsOfRun(recording, options, parameters) : std::nullopt;
    if (windows)
    {
      std::for_each(windows->begin(), windows->end(), judge);
    }
    SignalMonitor monitor(parameters.values);
    monitor.seekBearingSlip(parameters.values);
    RecordedUse recorded(parameters.values, use);
    const auto take = [&](const SignalSample& sample)
    {
      if (options.duty.empty())
      {
        recorded.add(sample);
      }
      if (is_assessed && !windows && monitor.update(sample))
      {
        judge(monitor.indicators());
      }
      return !options.watch.stopped();
    };
    if (options.duty.empty() || !windows)
    {
      readSignals(recording, options, parameters.values, take);
    }
    if (wear.is_read)
    {
      condition.read.readings.push_back({ hoursOf(options, i, use), wear });
    }
    any = any || judged.isJudged() || wear.is_read;
    why_not +=
        judged.isJudged() || wear.is_read ? "" : (why_not.empty() ? "" : "\n  ") + judged.whyNotJudged(recording);
  }
  if (is_assessed && !any && !options.watch.stopped())
  {
    throw InputError("nothing can be judged with the reference " + options.baseline + ": " + why_not);
  }
  return condition;
}

/// Names of the faults that would not raise an alarm at any severity; "none" if there are none.
std::string unseen(const SeenFrom& seen_from)
{
  std::vector<std::string> names;
  for (std::size_t cause = 0; cause < CAUSE_COUNT; ++cause)
  {
    if (std::isinf(seen_from[cause]))
    {
      names.emplace_back(causeName(static_cast<Cause>(cause)));
    }
  }
  return names.empty() ? "none" : joined(names);
}

/// @throws InputError if an option is out of range.
void requireRanges(const RemainingOptions& options)
{
  const std::vector<double>& hours = options.hours;
  if (hours.size() > 1 && (hours.size() != options.recordings.size() || !std::is_sorted(hours.begin(), hours.end())))
  {
    throw InputError("--hours has " + std::to_string(hours.size()) + " values for " +
                     std::to_string(options.recordings.size()) +
                     " recordings: give one value, or one for each recording, ascending");
  }
  for (const double value : hours)
  {
    requireWithin("hours", value, "h", { 1e-6, 1e7 });
  }
  requireWithin("lost_motion_limit", options.lost_motion_limit.value_or(1e-3), "rad", { 1e-6, 0.1 });
}
}  // namespace

void addOptions(OptionTable& table, RemainingOptions& options)
{
  addSignalOptions(table, options);
  table.add("--hours", options.hours,
            "hours that the drive was used as in the recordings [h]; default: duration of the recordings. A list, "
            "ascending: hours of use at which each recording was made");
  table
      .add("--baseline", options.baseline,
           "reference of the new drive, from `indicators`, to assess the recordings and read the wear")
      .type("FILE.yaml");
  table
      .add("--duty", options.duty,
           "use so far, as a duty cycle that `life age` reads; the recordings then serve only for the assessment")
      .type("FILE.csv")
      .existingFile()
      .needs("--baseline");
  table
      .add("--lost-motion-limit", options.lost_motion_limit,
           "lost motion at which the drive is at its end, in addition to the limits of wear [rad]; 1e-6 ... 0.1")
      .needs("--baseline");
  table.add("--use-record", options.use_record, "file for the use as a duty cycle, for `life` and life.use_record")
      .type("FILE.csv");
  addOptions(table, options, options.force);
}

Remaining remaining(const RemainingOptions& options)
{
  requireRanges(options);
  const RecordingParameters first = recordingParameters(options, options.recordings.front());
  Parameters parameters = first.values;
  parameters.life = assumedLife(options, first.values.life);
  requireWritable(options.use_record, options.force, options.recordings.front());
  UsageHistory use = options.duty.empty() ? UsageHistory(parameters.life) : UsageHistory(parameters.life, options.duty);
  Assessor assessor(parameters);
  if (!options.baseline.empty())
  {
    assessor.setReference(readBaseline(options.baseline, parameters, false));
  }
  Condition condition = readRecordings(options, assessor, use);
  const Assessment& assessment = condition.assessment;
  if (options.watch.stopped())
  {
    return {};
  }
  const bool assessed = assessment.state == AssessmentState::ASSESSED;
  if (use.turns() <= 0.0)
  {
    throw InputError(options.recordings.front() + ": the motor does not turn");
  }
  if (!options.hours.empty())
  {
    use = lasting(use, options.hours.back(), parameters.life);
  }
  if (options.lost_motion_limit && condition.read.readings.empty())
  {
    throw InputError("lost_motion_limit: no recording shows the lost motion beside " + options.baseline +
                     ": the load must have both signs, in the recording and in the reference");
  }
  condition.read.lost_motion_limit = options.lost_motion_limit.value_or(HUGE_VAL);
  if (!options.use_record.empty())
  {
    writeTextFile(options.use_record, use.text());
  }
  Remaining found;
  found.parameters = first.origin;
  found.estimate = LifeEstimator(parameters).estimate(use, assessed ? &assessment : nullptr, 0.0, condition.read);
  found.assessment = assessed ? std::make_optional(assessment) : std::nullopt;
  found.seen_from = condition.seen_from;
  if (!condition.read.readings.empty())
  {
    found.wear = condition.read.readings.back().reading;
  }
  return found;
}

Report reportOf(const Remaining& found)
{
  const LifeEstimate& estimate = found.estimate;
  const RemainingHours& remaining = estimate.remaining;
  std::vector<ReportLine> lines{
    { "hours", "hours of use so far", estimate.hours, "h" },
    { "turns", "turns of the motor so far", estimate.turns },
    { "remaining_q10", "remaining hours that 90 % of drives with this use reach", remaining.quantile[1], "h" },
    { "remaining_q50", "remaining hours that 50 % of drives with this use reach", remaining.quantile[2], "h" },
    { "remaining_q90", "remaining hours that 10 % of drives with this use reach", remaining.quantile[3], "h" },
    { "nearest", "nearest limit of the nominal drive", nameOf(estimate.nearest()) },
    { "used", "used share of this limit", 100.0 * estimate.usedOf(estimate.nearest()), "%" },
    { "parameters", "source of the parameters", found.parameters },
  };
  if (found.assessment)
  {
    lines.push_back({ "level", "assessed", levelName(found.assessment->level) });
    lines.push_back({ "largest_score", "largest score over threshold", found.assessment->largest_score });
    lines.push_back({ "cause", "cause", causeName(found.assessment->cause) });
  }
  if (found.seen_from)
  {
    lines.push_back({ "seen_from", "", seenFromJson(*found.seen_from) });
    lines.push_back({ "blind_to", "would not show", unseen(*found.seen_from) });
  }
  if (found.wear)
  {
    lines.push_back({ "wear_flank", "estimated wear, as a severity of tooth_wear", found.wear->flank });
    lines.push_back({ "wear_interface", "estimated wear, as a severity of interface_wear", found.wear->interface });
    lines.push_back({ "lost_motion", "lost motion", found.wear->lost_motion, "rad" });
  }
  lines.push_back({ "density", "", densityJson(remaining) });
  lines.push_back({ "end_probability", "", endJson(remaining) });
  return { lines, {} };
}
}  // namespace hjt
