// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
#include "motion_options.hpp"
#include "output_file.hpp"
#include "text_table.hpp"

namespace hjt
{
namespace
{
struct FollowOptions : MotionOptions
{
  std::string out;
};

int follow(const FollowOptions& options)
{
  const Parameters parameters = loadParameters(options);
  MotionDriven twin(parameters);
  std::optional<CsvWriter> csv;
  if (!options.out.empty())
  {
    requireWritable(options.out, options.force, options.recording);
    csv.emplace(options.out, std::vector<std::string>{ "time", "position", "velocity", "load", "current_measured",
                                                       "current_predicted", "current_residual", "current_band",
                                                       "motor_torque", "friction_torque" });
  }
  double squares = 0.0;
  double samples = 0.0;
  const MotionCount count = visitMotion(
      options, twin,
      [&](const MotionSample& sample)
      {
        const MotionPrediction predicted = twin.step(sample);
        const double residual = sample.current - predicted.current;
        squares += residual * residual;
        ++samples;
        if (csv)
        {
          csv->writeRow({ sample.time, sample.position, sample.velocity, sample.load, sample.current, predicted.current,
                          residual, predicted.band, predicted.motor_torque, predicted.friction_torque });
        }
      });
  if (csv)
  {
    csv->close();
  }
  const double rms = samples > 0.0 ? std::sqrt(squares / samples) : 0.0;
  if (options.json)
  {
    std::cout << nlohmann::ordered_json{
      { "rows", count.rows },
      { "unreadable", count.corrupt },
      { "duration", count.duration },
      { "current_residual_rms", rms }
    }.dump(2) << '\n';
  }
  else
  {
    printValues({ { "rows", std::to_string(count.rows), "" },
                  { "duration", shortNumber(count.duration), "s" },
                  { "measured less predicted current, rms", shortNumber(rms), "A" } });
  }
  return interruptSignal() == 0 ? EXIT_DONE : EXIT_BY_SIGNAL + interruptSignal();
}
}  // namespace

void addFollowCommand(CLI::App& app, int& exit_code)
{
  const auto options = std::make_shared<FollowOptions>();
  auto* command =
      app.add_subcommand("follow", "motion-driven: the motor torque and current that a recorded motion takes");
  addMotionOptions(*command, *options);
  command->add_option("--out", options->out, "every row, measured beside predicted")->type_name("FILE.csv");
  command->callback([options, &exit_code] { exit_code = follow(*options); });
}
}  // namespace hjt
