// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/remaining.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "output/output_file.hpp"
#include "recordings/recorded_windows.hpp"

#include "base/whole_file.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "health/baseline_file.hpp"
#include "health/signal_monitor.hpp"
#include "life/usage_history.hpp"

namespace hjt
{
namespace
{
/// Adds what the samples of a recording say of the drive's use. Gaps of a second and more are none.
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
    constexpr double LONGEST = 1.0;  // [s]
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
  double temperature_;  // of samples without one [degC]
  double ratio_;
  UsageHistory& use_;
  std::optional<SignalSample> last_;
};

/// The same use, gone on with for so many hours.
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

/// Where each bin begins and the chance that the end comes within it; the last bin has no end.
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

/// Chance of each end.
Json endJson(const RemainingHours& remaining)
{
  Json json;
  for (std::size_t i = 0; i < remaining.by_cause.size(); ++i)
  {
    json[nameOf(RemainingHours::CAUSES[i])] = remaining.by_cause[i];
  }
  return json;
}

/// Goes through the recordings: their use, unless a duty cycle says it, and the last assessment that counts, if there
/// is a reference to hold them against. @throws InputError if that comes to none.
Assessment readRecordings(const RemainingOptions& options, Assessor& assessor, UsageHistory& use)
{
  const bool is_assessed = !options.baseline.empty();
  Assessment assessment;
  bool any = false;
  std::string why_not;
  for (const std::string& recording : options.recordings)
  {
    const RecordingParameters parameters = recordingParameters(options, recording);
    ClosestAssessment judged;
    assessor.reset();
    const auto judge = [&](const SignalIndicators& window)
    {
      judged.take(assessor.update(window));
      assessment = supersedes(assessor.assessment(), assessment) ? assessor.assessment() : assessment;
    };
    const std::optional<std::vector<SignalIndicators>> windows =
        is_assessed ? windowsOfRun(recording, options, parameters) : std::nullopt;
    if (windows)
    {
      std::for_each(windows->begin(), windows->end(), judge);
    }
    SignalMonitor monitor(parameters.values);
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
    any = any || judged.isJudged();
    why_not += judged.isJudged() ? "" : (why_not.empty() ? "" : "\n  ") + judged.whyNotJudged(recording);
  }
  if (is_assessed && !any && !options.watch.stopped())
  {
    throw InputError("nothing can be judged by " + options.baseline + ": " + why_not);
  }
  return assessment;
}

}  // namespace

Remaining remaining(const RemainingOptions& options)
{
  const RecordingParameters first = recordingParameters(options, options.recordings.front());
  const Parameters& parameters = first.values;
  requireWritable(options.use_record, options.force, options.recordings.front());
  UsageHistory use = options.duty.empty() ? UsageHistory(parameters.life) : UsageHistory(parameters.life, options.duty);
  Assessor assessor(parameters);
  if (!options.baseline.empty())
  {
    assessor.setReference(readBaseline(options.baseline, parameters, false));
  }
  const Assessment assessment = readRecordings(options, assessor, use);
  if (options.watch.stopped())
  {
    return {};
  }
  const bool assessed = assessment.state == AssessmentState::ASSESSED;
  if (use.turns() <= 0.0)
  {
    throw InputError(options.recordings.front() + ": the motor does not turn");
  }
  if (options.hours)
  {
    use = lasting(use, *options.hours, parameters.life);
  }
  if (!options.use_record.empty())
  {
    writeTextFile(options.use_record, use.text());
  }
  Remaining found;
  found.parameters = first.origin;
  found.estimate = LifeEstimator(parameters).estimate(use, assessed ? &assessment : nullptr, 0.0);
  found.assessment = assessed ? std::make_optional(assessment) : std::nullopt;
  return found;
}

Report reportOf(const Remaining& found)
{
  const LifeEstimate& estimate = found.estimate;
  const RemainingHours& remaining = estimate.remaining;
  std::vector<ReportLine> lines{
    { "hours", "hours of use so far", estimate.hours, "h" },
    { "turns", "turns of the motor so far", estimate.turns },
    { "remaining_q10", "remaining, of 90 % of such drives at least", remaining.quantile[1], "h" },
    { "remaining_q50", "of half of them", remaining.quantile[2], "h" },
    { "remaining_q90", "of 10 % of them", remaining.quantile[3], "h" },
    { "nearest", "nearest limit of the nominal drive", nameOf(estimate.nearest()) },
    { "used", "used of it", 100.0 * estimate.usedOf(estimate.nearest()), "%" },
    { "parameters", "with the parameters of the", found.parameters },
  };
  if (found.assessment)
  {
    lines.push_back({ "level", "assessed", levelName(found.assessment->level) });
    lines.push_back({ "largest_score", "largest score over threshold", found.assessment->largest_score });
    lines.push_back({ "cause", "cause", causeName(found.assessment->cause) });
  }
  lines.push_back({ "density", "", densityJson(remaining) });
  lines.push_back({ "end_probability", "", endJson(remaining) });
  return { lines, {} };
}
}  // namespace hjt
