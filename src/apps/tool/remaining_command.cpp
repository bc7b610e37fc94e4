// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>
#include <string>

#include "apps/common/exit_code.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/report.hpp"
#include "apps/tool/recorded_signals.hpp"

#include "base/whole_file.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "life/life_estimate.hpp"

namespace hjt
{
namespace
{
struct RemainingOptions : SignalOptions
{
  std::optional<double> hours;
  std::string use_record;
};

/// Adds what a recording says of the drive's use. Gaps of a second and more are none.
void addUse(const std::string& path, const SignalSource& source, const Parameters& parameters, UsageHistory& use)
{
  constexpr double LONGEST = 1.0;  // [s]
  const double ratio = nominalRatio(parameters.gear);
  std::optional<SignalSample> last;
  readSignals(path, source,
              [&](const SignalSample& sample)
              {
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

int run(const RemainingOptions& options)
{
  const Parameters parameters = loadParameters(options);
  requireWritable(options.use_record, options.force, options.recordings.front());
  const SignalSource source = signalSource(options, parameters);
  UsageHistory use(parameters.life);
  for (const std::string& recording : options.recordings)
  {
    addUse(recording, source, parameters, use);
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
  const LifeEstimate estimate = LifeEstimator(parameters).estimate(use);
  const auto& quantile = estimate.remaining.quantile;  // 5, 10, 50, 90, 95 %
  printReport(options.json, { { "hours", "hours of use so far", estimate.hours, "h" },
                              { "turns", "turns of the motor so far", estimate.turns },
                              { "remaining_q10", "remaining, of 90 % of such drives at least", quantile[1], "h" },
                              { "remaining_q50", "of half of them", quantile[2], "h" },
                              { "remaining_q90", "of 10 % of them", quantile[3], "h" },
                              { "nearest", "nearest limit of the nominal drive", nameOf(estimate.nearest()) },
                              { "used", "used of it", 100.0 * estimate.usedOf(estimate.nearest()), "%" } });
  return EXIT_DONE;
}

void declare(Command& command, RemainingOptions& options)
{
  addSignalOptions(command, options);
  command
      .add("--hours", options.hours, "use that the drive has behind it, all like the recordings [h]; default: theirs")
      .range(1e-6, 1e7);
  command.add("--use-record", options.use_record, "writes the use as a duty cycle, for `life` and life.use_record")
      .type("FILE.csv");
  addCommonOptions(command, options);
}

const Subcommand REMAINING{ Subject::RECORDING, "remaining",
                            "use of a recorded joint, and how long a drive lasts that is used so", declare, run };
}  // namespace
}  // namespace hjt
