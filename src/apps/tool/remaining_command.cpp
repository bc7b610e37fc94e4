// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/exit_code.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/report.hpp"
#include "apps/tool/recorded_signals.hpp"

#include "base/whole_file.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/health/assessment.hpp"
#include "health/baseline_file.hpp"
#include "health/signal_monitor.hpp"
#include "life/life_estimate.hpp"

namespace hjt
{
namespace
{
struct RemainingOptions : SignalOptions
{
  std::optional<double> hours;
  std::string baseline;
  std::string use_record;
};

/// Adds what a recording says of the drive's use. Gaps of a second and more are none. Every sample goes to `watch` too.
void addUse(const std::string& path, const SignalSource& source, const Parameters& parameters, UsageHistory& use,
            const std::function<void(const SignalSample&)>& watch)
{
  constexpr double LONGEST = 1.0;  // [s]
  const double ratio = nominalRatio(parameters.gear);
  std::optional<SignalSample> last;
  readSignals(path, source,
              [&](const SignalSample& sample)
              {
                watch(sample);
                const auto motor = [&](const SignalSample& of)
                { return std::isfinite(of.motor_angle) ? of.motor_angle : ratio * of.output_angle; };
                const double seconds = last ? 1e-9 * static_cast<double>(sample.stamp - last->stamp) : 0.0;
                const double speed = last ? std::abs(motor(sample) - motor(*last)) / seconds : 0.0;
                const double torque =
                    std::isfinite(sample.load_torque) ?
                        sample.load_torque + parameters.output.gravity_torque *
                                                 (parameters.output.gravity_torque != 0.0 ?
                                                      std::sin(sample.output_angle - parameters.output.gravity_angle) :
                                                      0.0) :
                        ratio * sample.motor_torque;
                if (seconds > 0.0 && seconds < LONGEST && std::isfinite(speed) && std::isfinite(torque))
                {
                  use.add({ seconds, speed, torque,
                            std::isfinite(sample.temperature) ? sample.temperature : parameters.input.temperature });
                }
                last = std::isfinite(motor(sample)) ? sample : last;
                return true;
              });
}

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

int run(const RemainingOptions& options)
{
  const Parameters parameters = loadParameters(options);
  requireWritable(options.use_record, options.force, options.recordings.front());
  const SignalSource source = signalSource(options, parameters);
  UsageHistory use(parameters.life);
  Assessor assessor(parameters);
  if (!options.baseline.empty())
  {
    assessor.setReference(readBaseline(options.baseline, parameters, false));
  }
  Assessment assessment;  // the last one that counts
  for (const std::string& recording : options.recordings)
  {
    SignalMonitor monitor(parameters);
    assessor.reset();
    addUse(recording, source, parameters, use,
           [&](const SignalSample& sample)
           {
             if (!options.baseline.empty() && monitor.update(sample) &&
                 supersedes(assessor.update(monitor.indicators()), assessment))
             {
               assessment = assessor.assessment();
             }
           });
  }
  const bool assessed = assessment.state == AssessmentState::ASSESSED;
  if (!options.baseline.empty() && !assessed)
  {
    throw InputError(options.recordings.front() + ": no window lies at an operating point that " + options.baseline +
                     " knows");
  }
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
  const LifeEstimate estimate = LifeEstimator(parameters).estimate(use, assessed ? &assessment : nullptr, 0.0);
  const RemainingHours& remaining = estimate.remaining;
  std::vector<ReportLine> lines{
    { "hours", "hours of use so far", estimate.hours, "h" },
    { "turns", "turns of the motor so far", estimate.turns },
    { "remaining_q10", "remaining, of 90 % of such drives at least", remaining.quantile[1], "h" },
    { "remaining_q50", "of half of them", remaining.quantile[2], "h" },
    { "remaining_q90", "of 10 % of them", remaining.quantile[3], "h" },
    { "nearest", "nearest limit of the nominal drive", nameOf(estimate.nearest()) },
    { "used", "used of it", 100.0 * estimate.usedOf(estimate.nearest()), "%" },
  };
  if (assessed)
  {
    lines.push_back({ "level", "assessed", levelName(assessment.level) });
    lines.push_back({ "cause", "cause", causeName(assessment.cause) });
  }
  if (options.json)
  {
    lines.push_back({ "density", "", densityJson(remaining) });
    lines.push_back({ "end_probability", "", endJson(remaining) });
  }
  printReport(options.json, lines);
  return EXIT_DONE;
}

void declare(Command& command, RemainingOptions& options)
{
  addSignalOptions(command, options);
  command
      .add("--hours", options.hours, "use that the drive has behind it, all like the recordings [h]; default: theirs")
      .range(1e-6, 1e7);
  command
      .add("--baseline", options.baseline,
           "reference of the new drive, from `indicators`: the last window compared with it tells of wear")
      .type("FILE.yaml");
  command.add("--use-record", options.use_record, "writes the use as a duty cycle, for `life` and life.use_record")
      .type("FILE.csv");
  addCommonOptions(command, options);
}

const Subcommand REMAINING{ Subject::RECORDING, "remaining",
                            "use of a recorded joint, and how long a drive lasts that is used so", declare, run };
}  // namespace
}  // namespace hjt
