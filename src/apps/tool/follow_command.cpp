// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/exit_code.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/motion_options.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/progress.hpp"
#include "apps/common/report.hpp"
#include "apps/common/surface_source.hpp"
#include "apps/common/text_table.hpp"

#include "tracking/tracker.hpp"

namespace hjt
{
namespace
{
const std::map<std::string, InputMode> MODES{ { "torque", InputMode::TORQUE },
                                              { "motion", InputMode::MOTION },
                                              { "observer", InputMode::OBSERVER } };

struct FollowOptions : MotionOptions
{
  std::string mode;
  std::string out;
};

/// As the fields of Comparison.msg.
const std::vector<Column<Comparison>> COLUMNS{
  { "time", &Comparison::time },
  { "position_measured", [](const Comparison& now) { return now.position.measured; } },
  { "position_predicted", [](const Comparison& now) { return now.position.predicted; } },
  { "position_residual", [](const Comparison& now) { return now.position.residual(); } },
  { "position_band", [](const Comparison& now) { return now.position.band; } },
  { "velocity_measured", [](const Comparison& now) { return now.velocity.measured; } },
  { "velocity_predicted", [](const Comparison& now) { return now.velocity.predicted; } },
  { "velocity_residual", [](const Comparison& now) { return now.velocity.residual(); } },
  { "current_measured", [](const Comparison& now) { return now.current.measured; } },
  { "current_predicted", [](const Comparison& now) { return now.current.predicted; } },
  { "current_residual", [](const Comparison& now) { return now.current.residual(); } },
  { "current_band", [](const Comparison& now) { return now.current.band; } },
  { "residual_torque", &Comparison::residual_torque },
  { "joint_torque", &Comparison::joint_torque },
  { "friction_torque", &Comparison::friction_torque },
  { "load_torque", &Comparison::load_torque },
  { "load_told", &Comparison::load_provided },
  { "sticking", &Comparison::sticking },
  { "after_gap", &Comparison::after_gap },
  { "outside_band", &Comparison::isOutside }
};

/// Root mean square of what is added.
class Rms
{
public:
  void add(double value)
  {
    squares_ += value * value;
    ++count_;
  }
  double value() const { return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0.0; }

private:
  double squares_{};
  std::uint64_t count_{};
};

struct FollowSummary
{
  MotionCount count;
  TrackerCounters counters;
  StreamTimingReport timing;
  std::optional<double> lag;
  Rms current;
  Rms velocity;
  Rms position;
};

FollowSummary compare(const FollowOptions& options, Tracker& tracker,
                      const std::function<void(const Comparison&)>& visit)
{
  const MotionSource source = motionSource(options);
  const bool has_load = recordsLoad(source);
  Progress progress("reading");
  FollowSummary summary;
  const auto take_all = [&](bool at_end)
  {
    while (const std::optional<Comparison> now = tracker.pop(at_end))
    {
      summary.current.add(now->current.residual());
      summary.velocity.add(now->velocity.residual());
      summary.position.add(now->position.residual());
      visit(*now);
    }
  };
  summary.count = readMotion(
      source,
      [&](const MotionRow& row)
      {
        if (has_load)
        {
          tracker.pushLoad(row.time, row.load);
        }
        tracker.push(row);
        take_all(false);
        return interruptSignal() == 0;
      },
      [&](double done) { progress.update(done); });
  take_all(true);
  summary.counters = tracker.counters();
  summary.timing = tracker.timing();
  summary.lag = tracker.lag();
  return summary;
}

void print(const FollowSummary& summary, bool json)
{
  printReport(
      json, { { "rows", "rows", summary.count.rows },
              { "duration", "duration", summary.count.duration, "s" },
              { "unreadable", "messages unreadable", summary.count.corrupt },
              { "refused", "rows refused: repeated, out of order, impossible values", summary.counters.refused },
              { "missing", "rows missing, at a period of " + shortNumber(summary.timing.period) + " s",
                summary.timing.missing },
              { "period", "", summary.timing.period },
              { "gaps", "gaps that cut the recording", summary.counters.gaps },
              { "reception_offset", "reception minus stamp", summary.timing.offset, "s" },
              { "reception_jitter", "jitter of the reception, 95 %", summary.timing.jitter, "s" },
              { "lag", "", summary.lag },
              { "", "delay of the measurement", summary.lag ? Json(*summary.lag) : "unknown", summary.lag ? "s" : "" },
              { "without_load", "rows without a received load", summary.counters.without_load },
              { "current_residual_rms", "measured less predicted current, rms", summary.current.value(), "A" },
              { "velocity_residual_rms", "measured less predicted velocity, rms", summary.velocity.value(), "rad/s" },
              { "position_residual_rms", "measured less predicted position, rms", summary.position.value(), "rad" },
              { "outside", "rows outside the band of the current", summary.counters.outside },
              { "solver_failures", "", summary.counters.solver_failures } });
}

int follow(const FollowOptions& options)
{
  const Parameters parameters = loadParameters(options);
  requireWritable(options.out, options.force, options.recording);
  std::optional<TableFile<Comparison>> csv;
  if (!options.out.empty())
  {
    csv.emplace(options.out, COLUMNS);
  }
  const MotionSource source = motionSource(options);
  if (parameters.telemetry.load == LoadSource::MODEL && recordsLoad(source))
  {
    std::cerr << "joint_twin: the recording holds a load (" << (isCsv(source) ? "target_moment" : source.load_topic)
              << "), but telemetry.load = model leaves it out; for a controller's rigid-body torque give --config "
                 "recorded_load.yaml after the joint's own file\n";
  }
  Tracker tracker(parameters, MODES.at(options.mode), surfaceSource());
  const FollowSummary summary = compare(options, tracker,
                                        [&](const Comparison& now)
                                        {
                                          if (csv)
                                          {
                                            csv->write(now);
                                          }
                                        });
  if (csv)
  {
    csv->close();
  }
  warnOfStamps(summary.count);
  print(summary, options.json);
  return interruptSignal() == 0 ? EXIT_DONE : EXIT_BY_SIGNAL + interruptSignal();
}

void declare(Command& command, FollowOptions& options)
{
  addMotionOptions(command, options);
  options.mode = "motion";
  command.add("--mode", options.mode, "input of the twin: the recorded current, motion, or both")
      .choice({ "motion", "observer", "torque" });
  command.add("--out", options.out, "every row, measured and predicted").type("FILE.csv");
}

const Subcommand FOLLOW{ Subject::RECORDING, "follow",
                         "runs a healthy joint on a recording: measured and predicted motion and current", declare,
                         follow };
}  // namespace
}  // namespace hjt
