// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/configuration.hpp"
#include "apps/common/surface_source.hpp"
#include "base/number_table.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "output/interrupt.hpp"
#include "output/output_file.hpp"
#include "output/progress.hpp"
#include "output/run_summary.hpp"
#include "output/text_table.hpp"
#include "recordings/recording_options.hpp"

#include "bags/bag_recorder.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
enum ProfileColumn
{
  TIME,
  MOTOR_TORQUE,
  LOAD_TORQUE,
  BRAKE,
  COLUMNS
};

constexpr Range TIMES{ 0.0, 1e9 };  // a stamp holds them [s]

/// Inputs of a simulation: motor torque, load and brake over time, each held until the next entry.
class TorqueProfile
{
public:
  /// A constant torque from t = 0 on [N.m].
  static TorqueProfile constant(double motor_torque)
  {
    TorqueProfile profile;
    profile.inputs_.push_back({ 0, InputKind::MOTOR_TORQUE, motor_torque });
    return profile;
  }

  /// CSV with columns time [s, from 0 on, ascending], motor_torque [N.m] and, if wanted, load_torque [N.m] and brake (0
  /// or 1). @throws InputError naming line and column.
  static TorqueProfile fromFile(const std::string& path)
  {
    constexpr std::size_t OPTIONAL_COLUMNS = 2;
    NumberTable<COLUMNS> table(path, { "time", "motor_torque", "load_torque", "brake" }, OPTIONAL_COLUMNS);
    TorqueProfile profile;
    profile.has_load_ = table.hasColumn(LOAD_TORQUE);
    std::array<double, COLUMNS> row{};
    for (double last = -1.0; table.read(row); last = row[TIME])
    {
      if (row[TIME] < 0.0 || row[TIME] <= last)
      {
        throw InputError(table.place() + ": column 'time' must start at 0 or later and ascend");
      }
      table.requireRange(TIME, row[TIME], TIMES, "s");
      const auto stamp = static_cast<Stamp>(std::llround(row[TIME] * 1e9));
      profile.inputs_.push_back({ stamp, InputKind::MOTOR_TORQUE, row[MOTOR_TORQUE] });
      if (table.hasColumn(LOAD_TORQUE))
      {
        profile.inputs_.push_back({ stamp, InputKind::LOAD_TORQUE, row[LOAD_TORQUE] });
      }
      if (table.hasColumn(BRAKE))
      {
        if (row[BRAKE] != 0.0 && row[BRAKE] != 1.0)
        {
          throw InputError(table.place() + ": column 'brake' must be 0 or 1");
        }
        profile.inputs_.push_back({ stamp, InputKind::BRAKE, row[BRAKE] });
      }
    }
    if (profile.inputs_.empty())
    {
      throw InputError(path + " has no rows");
    }
    return profile;
  }

  bool hasLoad() const { return has_load_; }

  /// At t = 0 [N.m]
  void setLoad(double load_torque)
  {
    has_load_ = true;
    inputs_.insert(inputs_.begin(), { 0, InputKind::LOAD_TORQUE, load_torque });
  }

  Stamp duration() const { return inputs_.back().stamp; }  ///< up to the last entry [ns]

  /// Gives the twin, standing at its instant, what acts in its next step. `begin`: the instant of t = 0.
  void feed(Twin& twin, Stamp begin)
  {
    // A profile holds its torque for any time; the command is repeated at every instant, so it does not time out.
    twin.commandMotorTorque(twin.stamp(), motor_torque_);
    const Stamp end = twin.stamp() + twin.stepLength();
    for (; next_ < inputs_.size() && begin + inputs_[next_].stamp < end; ++next_)
    {
      const Input& input = inputs_[next_];
      motor_torque_ = input.kind == InputKind::MOTOR_TORQUE ? input.value : motor_torque_;
      twin.push({ begin + input.stamp, input.kind, input.value });
    }
  }

private:
  std::vector<Input> inputs_;  ///< stamps from t = 0 on
  std::size_t next_{};
  bool has_load_{};
  double motor_torque_{};
};

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

void declare(OptionTable& table, SimulateOptions& options)
{
  table.add("--duration", options.duration, "simulated time [s]; default: up to the profile's last row").positive();
  table.add("--torque", options.torque, "constant motor torque [N.m]").needs("--duration");
  table
      .add("--profile", options.profile,
           "CSV with columns time [s], motor_torque [N.m] and, if wanted, load_torque [N.m], brake (0 or 1); each row "
           "holds until the next")
      .type("FILE.csv");
  table.oneOf({ "--torque", "--profile" });
  table.add("--load", options.load, "constant external torque at the output; > 0 resists positive motion [N.m]");
  table.add("--out", options.out, "bag with the node's topics, or CSV with a row per joint_states")
      .required()
      .type("FILE.bag|FILE.csv")
      .endsIn({ ".bag", ".csv" });
  addNamespaceOption(table, options.joint_namespace);
  addFaultOption(table, options);
  addCommonOptions(table, options);
}

const Subcommand SIMULATE{ Subject::JOINT, "simulate", "run the twin under a given torque", declare, simulate };
}  // namespace
}  // namespace hjt
