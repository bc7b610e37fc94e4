// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/configuration.hpp"
#include "apps/common/motion_options.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "recordings/indicators.hpp"
#include "recordings/recorded_signals.hpp"
#include "recordings/remaining.hpp"

namespace hjt
{
namespace
{
/// Options of signals without the common ones, which a command adds behind its own.
void addSignalOptions(Command& command, SignalOptions& options)
{
  command
      .add("recordings", options.recordings,
           "one recording, or several of the same joint; a run of a data set (HDF5) is read with the parameters in its "
           "file, "
           "over them those of --config and --set")
      .required()
      .type("IN.csv|IN.bag|IN.h5")
      .check(wrongSignalFile);
  command.add("--joint", options.joint,
              "bag: a robot's joint on /joint_states, effort in A, by telemetry.torque_per_current: base, shoulder, "
              "elbow, wrist_1 ..., or its name in the messages; default: the twin's own");
  SignalSource& source = options.source;
  const auto column = [&command](const char* name, std::string& field, const char* meaning)
  { command.add(name, field, meaning).type("COLUMN"); };
  column("--time", source.time, "CSV, HDF5: time [s]; default: time");
  column("--motor-torque", source.motor_torque,
         "CSV, HDF5: motor torque, or current with --torque-scale; default: motor_torque_reading, else "
         "motor_torque");
  column("--motor-angle", source.motor_angle, "CSV, HDF5: motor encoder [rad]; default: motor_angle_encoder");
  column("--output-angle", source.output_angle, "CSV, HDF5: output encoder [rad]; default: output_angle_encoder");
  column("--motor-velocity", source.motor_velocity,
         "CSV, HDF5: motor speed [rad/s]; default: motor_velocity_encoder, else differences of the angle");
  column("--load-torque", source.load_torque,
         "CSV, HDF5: load torque at the output, > 0 resists positive motion [N.m]; default: load_torque");
  column("--temperature", source.temperature,
         "CSV, HDF5: temperature [degC]; default: housing_temperature, else temperature");
  column("--target-angle", source.target_angle,
         "CSV, HDF5: set point of the output angle [rad]; default: target_angle");
  command.add("--torque-scale", options.torque_scale,
              "motor torque per unit of the recorded signal [N.m]; default: 1, and with --joint "
              "telemetry.torque_per_current / ratio [N.m/A]");
  command
      .add("--states-topic", options.states_topic,
           "bag: JointState messages; default: NAMESPACE/joint_states, and with --joint /joint_states")
      .type("TOPIC");
  command.add("--load-topic", options.load_topic, "bag: load torque; default: NAMESPACE/load").type("TOPIC");
  addNamespaceOption(command, options.joint_namespace);
}

using PrintedIndicators = Printed<IndicatorsOptions>;

int runIndicators(const PrintedIndicators& given)
{
  PrintedIndicators options = given;
  options.watch = consoleWatch();
  const AssessedWindows found = indicators(options);
  if (!found.windows.empty())
  {
    options.json ? printReport(true, reportOf(found).lines) : printSummary(found.windows);
  }
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  return found.unread.empty() && (options.baseline.empty() || found.is_judged) ? EXIT_DONE : EXIT_FAILED;
}

void declare(Command& command, PrintedIndicators& options)
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
            "the reference is of another motion to and fro, best a check-up; the recordings of --model carry it to "
            "this one")
      .needs("--baseline")
      .needs("--model");
  command.add("--save-baseline", options.save_baseline, "writes the reference that was learned").type("FILE.yaml");
  command.add("--out", options.out, "CSV with a row per window").type("FILE.csv");
  addCommonOptions(command, options, options.json, options.force);
}

const Subcommand INDICATORS{
  Subject::RECORDING, "indicators",
  "health indicators and assessment of a recording, from encoders and torque or current alone", declare, runIndicators
};

using PrintedRemaining = Printed<RemainingOptions>;

int runRemaining(const PrintedRemaining& given)
{
  PrintedRemaining options = given;
  options.watch = consoleWatch();
  const Report report = reportOf(remaining(options));
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  printReport(options.json, report.lines, report.tables);
  return EXIT_DONE;
}

void declare(Command& command, PrintedRemaining& options)
{
  addSignalOptions(command, options);
  command.add("--hours", options.hours,
              "hours of use behind the drive, all as in the recordings [h]; default: those of the recordings. A list, "
              "ascending: "
              "the hours at which each recording was made");
  command
      .add("--baseline", options.baseline,
           "reference of the new drive, from `indicators`: verdicts and readings by it tell of wear")
      .type("FILE.yaml");
  command
      .add("--duty", options.duty,
           "use so far, as a duty cycle that `life age` reads; the recordings are then assessed only")
      .type("FILE.csv")
      .existingFile()
      .needs("--baseline");
  command
      .add("--lost-motion-limit", options.lost_motion_limit,
           "lost motion at which the drive is at its end, beside the limits of wear [rad]; 1e-6 ... 0.1")
      .needs("--baseline");
  command.add("--use-record", options.use_record, "writes the use as a duty cycle, for `life` and life.use_record")
      .type("FILE.csv");
  addCommonOptions(command, options, options.json, options.force);
}

const Subcommand REMAINING{ Subject::RECORDING, "remaining",
                            "use of a recorded joint, and how long a drive lasts that is used so", declare,
                            runRemaining };
}  // namespace
}  // namespace hjt
