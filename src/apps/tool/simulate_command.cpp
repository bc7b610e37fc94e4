// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <optional>
#include <string>

#include "apps/common/configuration.hpp"
#include "apps/common/surface_source.hpp"
#include "apps/tool/torque_profile.hpp"
#include "output/interrupt.hpp"
#include "output/output_file.hpp"
#include "output/progress.hpp"
#include "output/run_summary.hpp"
#include "output/text_table.hpp"

#include "bags/bag_recorder.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
struct SimulateOptions : CommonOptions
{
  std::optional<double> duration;
  std::optional<double> torque;
  std::string profile;
  std::optional<double> load;
  std::string out;
  std::string joint_namespace{ DEFAULT_NAMESPACE };
};

TorqueProfile makeProfile(const SimulateOptions& options)
{
  TorqueProfile profile =
      options.torque ? TorqueProfile::constant(*options.torque) : TorqueProfile::fromFile(options.profile);
  if (options.load)
  {
    if (profile.hasLoad())
    {
      throw InputError(options.profile + " has a column 'load_torque'; leave out --load");
    }
    profile.setLoad(*options.load);
  }
  return profile;
}

/// One row per instant of joint_states.
class CsvRecorder
{
public:
  CsvRecorder(const Twin& twin, const std::string& path, Stamp begin)
    : period_(publishPeriod(twin.parameters().publish.joint_states_rate, twin.parameters().solver.rate))
    , begin_(begin)
    , csv_(path, { "time",
                   "motor_angle",
                   "motor_velocity",
                   "output_angle",
                   "output_velocity",
                   "motor_angle_encoder",
                   "motor_velocity_encoder",
                   "output_angle_encoder",
                   "output_velocity_encoder",
                   "motor_torque",
                   "motor_torque_reading",
                   "load_torque",
                   "wave_generator_torque",
                   "joint_torque",
                   "friction_torque",
                   "torsional_stiffness",
                   "energy_residual",
                   "temperature",
                   "housing_temperature",
                   "brake",
                   "converged" })
  {
  }

  void record(Twin& twin)
  {
    if (twin.stamp() % period_ != 0)
    {
      return;
    }
    ++rows_;
    const JointOutputs& o = twin.outputs();
    const EncoderReadings e = twin.encoders();
    csv_.writeRow({ toSeconds(o.stamp - begin_), o.motor_angle,  o.motor_velocity,          o.output_angle,
                    o.output_velocity,           e.motor_angle,  e.motor_velocity,          e.output_angle,
                    e.output_velocity,           o.motor_torque, twin.motorTorqueReading(), o.load_torque,
                    o.wave_generator_torque,     o.joint_torque, o.friction_torque,         o.torsional_stiffness,
                    o.energy_residual,           o.temperature,  o.housing_temperature,     o.brake_engaged ? 1.0 : 0.0,
                    o.converged ? 1.0 : 0.0 });
  }

  void close() { csv_.close(); }
  std::uint64_t rows() const { return rows_; }

private:
  Stamp period_;  // [ns]
  Stamp begin_;
  std::uint64_t rows_{};
  CsvWriter csv_;
};

template <class Recorder>
void run(Twin& twin, TorqueProfile& profile, Stamp end, Recorder& recorder)
{
  const Stamp begin = twin.stamp();
  Progress progress("simulating");
  profile.feed(twin, begin);
  while (interruptSignal() == 0 && twin.step(end))
  {
    recorder.record(twin);
    progress.update(static_cast<double>(twin.stamp() - begin) / static_cast<double>(end - begin));
    profile.feed(twin, begin);
  }
}

int simulate(const SimulateOptions& options)
{
  const std::string extension = std::filesystem::path(options.out).extension().string();
  const Parameters parameters = loadParameters(options);
  requireWritable(options.out, options.force, options.profile);
  TorqueProfile profile = makeProfile(options);
  Twin twin(parameters, surfaceSource());
  printGearWarnings(parameters);
  twin.reset(SIMULATION_EPOCH);
  const RunSummary summary{ options.out, twin.stamp() };
  const Stamp end = twin.stamp() + (options.duration ? toStampLength(*options.duration) : profile.duration());
  std::uint64_t recorded = 0;
  const InterruptScope interrupts;
  if (extension == ".csv")
  {
    CsvRecorder recorder(twin, options.out, twin.stamp());
    run(twin, profile, end, recorder);
    recorded = recorder.rows();
    if (recorded > 0)
    {
      recorder.close();
    }
  }
  else
  {
    twin.watchSignals(true);
    BagWriter bag(options.out);
    BagRecorder recorder(twin, options.joint_namespace, bag);
    run(twin, profile, end, recorder);
    bag.close();
    recorded = bag.messages();
  }
  if (recorded == 0 && interruptSignal() == 0)
  {
    throw InputError(options.out + " holds nothing: the run of " + shortNumber(toSeconds(end - summary.begin)) +
                     " s is shorter than a period of publish.joint_states_rate = " +
                     shortNumber(parameters.publish.joint_states_rate) + " Hz");
  }
  return summary.report(twin, options.json);
}

void declare(Command& command, SimulateOptions& options)
{
  command.add("--duration", options.duration, "simulated time [s]; default: up to the profile's last row").positive();
  command.add("--torque", options.torque, "constant motor torque [N.m]").needs("--duration");
  command
      .add("--profile", options.profile,
           "CSV with columns time [s], motor_torque [N.m] and, if wanted, load_torque [N.m], brake (0 or 1); each row "
           "holds until the next")
      .type("FILE.csv");
  command.oneOf({ "--torque", "--profile" });
  command.add("--load", options.load, "constant external torque at the output; > 0 resists positive motion [N.m]");
  command.add("--out", options.out, "bag with the node's topics, or CSV with a row per joint_states")
      .required()
      .type("FILE.bag|FILE.csv")
      .bagOrCsv();
  addNamespaceOption(command, options.joint_namespace);
  addFaultOption(command, options);
  addCommonOptions(command, options);
}

const Subcommand SIMULATE{ Subject::JOINT, "simulate", "run the twin under a given torque", declare, simulate };
}  // namespace
}  // namespace hjt
