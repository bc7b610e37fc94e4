// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/common/exit_code.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/motion_options.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/progress.hpp"
#include "apps/common/surface_source.hpp"
#include "apps/common/text_table.hpp"
#include "apps/tool/commands.hpp"

#include "tracking/companion.hpp"

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

/// Columns as the fields of Comparison.msg.
const std::vector<std::string>& columns()
{
  static const std::vector<std::string> NAMES{ "time",
                                               "position_measured",
                                               "position_predicted",
                                               "position_residual",
                                               "position_band",
                                               "velocity_measured",
                                               "velocity_predicted",
                                               "velocity_residual",
                                               "current_measured",
                                               "current_predicted",
                                               "current_residual",
                                               "current_band",
                                               "residual_torque",
                                               "joint_torque",
                                               "friction_torque",
                                               "load_torque",
                                               "load_told",
                                               "sticking",
                                               "after_gap",
                                               "outside_band" };
  return NAMES;
}

std::vector<double> values(const Comparison& now)
{
  return { now.time,
           now.position.measured,
           now.position.predicted,
           now.position.residual(),
           now.position.band,
           now.velocity.measured,
           now.velocity.predicted,
           now.velocity.residual(),
           now.current.measured,
           now.current.predicted,
           now.current.residual(),
           now.current.band,
           now.residual_torque,
           now.joint_torque,
           now.friction_torque,
           now.load_torque,
           now.load_told ? 1.0 : 0.0,
           now.sticking ? 1.0 : 0.0,
           now.after_gap ? 1.0 : 0.0,
           now.isOutside() ? 1.0 : 0.0 };
}

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
  CompanionCounters counters;
  StreamTimingReport timing;
  std::optional<double> lag;
  Rms current;
  Rms velocity;
  Rms position;
};

FollowSummary compare(const FollowOptions& options, Companion& companion,
                      const std::function<void(const Comparison&)>& visit)
{
  const MotionSource source = motionSource(options);
  const bool has_load = recordsLoad(source);
  Progress progress("reading");
  FollowSummary summary;
  const auto take_all = [&](bool at_end)
  {
    while (const std::optional<Comparison> now = companion.take(at_end))
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
          companion.giveLoad(row.time, row.load);
        }
        companion.give(row);
        take_all(false);
        return interruptSignal() == 0;
      },
      [&](double done) { progress.update(done); });
  take_all(true);
  summary.counters = companion.counters();
  summary.timing = companion.timing();
  summary.lag = companion.lag();
  return summary;
}

void print(const FollowSummary& summary)
{
  printValues(
      { { "rows", std::to_string(summary.count.rows), "" },
        { "duration", shortNumber(summary.count.duration), "s" },
        { "messages unreadable", std::to_string(summary.count.corrupt), "" },
        { "rows refused: repeated, out of order, beyond what can be", std::to_string(summary.counters.refused), "" },
        { "rows missing, at a period of " + shortNumber(summary.timing.period) + " s",
          std::to_string(summary.timing.missing), "" },
        { "gaps that cut the recording", std::to_string(summary.counters.gaps), "" },
        { "reception less stamp", shortNumber(summary.timing.offset), "s" },
        { "jitter of the reception, 95 %", shortNumber(summary.timing.jitter), "s" },
        { "measured after predicted", summary.lag ? shortNumber(*summary.lag) : "not told", summary.lag ? "s" : "" },
        { "rows without a told load", std::to_string(summary.counters.without_load), "" },
        { "measured less predicted current, rms", shortNumber(summary.current.value()), "A" },
        { "measured less predicted velocity, rms", shortNumber(summary.velocity.value()), "rad/s" },
        { "measured less predicted position, rms", shortNumber(summary.position.value()), "rad" },
        { "rows outside the band of the current", std::to_string(summary.counters.outside), "" } });
}

void printJson(const FollowSummary& summary)
{
  std::cout << nlohmann::ordered_json{
    { "rows", summary.count.rows },
    { "unreadable", summary.count.corrupt },
    { "refused", summary.counters.refused },
    { "missing", summary.timing.missing },
    { "period", summary.timing.period },
    { "gaps", summary.counters.gaps },
    { "reception_offset", summary.timing.offset },
    { "reception_jitter", summary.timing.jitter },
    { "lag", summary.lag ? nlohmann::ordered_json(*summary.lag) : nlohmann::ordered_json() },
    { "without_load", summary.counters.without_load },
    { "duration", summary.count.duration },
    { "current_residual_rms", summary.current.value() },
    { "velocity_residual_rms", summary.velocity.value() },
    { "position_residual_rms", summary.position.value() },
    { "outside", summary.counters.outside },
    { "solver_failures", summary.counters.solver_failures }
  }.dump(2) << '\n';
}

int follow(const FollowOptions& options)
{
  const Parameters parameters = loadParameters(options);
  std::optional<CsvWriter> csv;
  if (!options.out.empty())
  {
    requireWritable(options.out, options.force, options.recording);
    csv.emplace(options.out, columns());
  }
  Companion companion(parameters, MODES.at(options.mode), surfaceSource());
  const FollowSummary summary = compare(options, companion,
                                        [&](const Comparison& now)
                                        {
                                          if (csv)
                                          {
                                            csv->writeRow(values(now));
                                          }
                                        });
  if (csv)
  {
    csv->close();
  }
  options.json ? printJson(summary) : print(summary);
  return interruptSignal() == 0 ? EXIT_DONE : EXIT_BY_SIGNAL + interruptSignal();
}
}  // namespace

void addFollowCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<FollowOptions>();
  auto* command =
      app.add_subcommand("follow", "a healthy joint beside a recorded one: measured and predicted motion and current");
  addMotionOptions(*command, *options);
  options->mode = "motion";
  command->add_option("--mode", options->mode, "what drives the twin: the recorded current, motion, or both")
      ->check(CLI::IsMember(MODES))
      ->capture_default_str();
  command->add_option("--out", options->out, "every row, measured beside predicted")->type_name("FILE.csv");
  command->callback([options, &exit_code] { exit_code = follow(*options); });
}
}  // namespace hjt
