// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <rosbag/view.h>

#include "apps/common/configuration.hpp"
#include "apps/common/library_command.hpp"
#include "bags/bag_file.hpp"
#include "bags/bag_inputs.hpp"
#include "bags/bag_recorder.hpp"
#include "base/csv_table.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "output/output_file.hpp"
#include "output/process_end.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "recordings/recording_options.hpp"

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

constexpr Range TIMES{ 0.0, 1e9 };  // range of a stamp [s]

/// Inputs of a simulation: motor torque, load and brake over time. Each value is constant until the next row.
class TorqueProfile
{
public:
  /// Profile with a constant motor torque [N.m] from t = 0 on.
  static TorqueProfile constant(double motor_torque)
  {
    TorqueProfile profile;
    profile.inputs_.push_back({ 0, InputKind::MOTOR_TORQUE, motor_torque });
    return profile;
  }

  /// Reads a CSV file with columns time [s, from 0, ascending], motor_torque [N.m] and optionally load_torque [N.m] and
  /// brake (0 or 1). @throws InputError with line and column.
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
        throw InputError(table.place() + ": column 'time' must be >= 0 and ascending");
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

  /// Sets the load torque [N.m] from t = 0 on.
  void setLoad(double load_torque)
  {
    has_load_ = true;
    inputs_.insert(inputs_.begin(), { 0, InputKind::LOAD_TORQUE, load_torque });
  }

  Stamp duration() const { return inputs_.back().stamp; }  ///< time of the last input after t = 0 [ns]

  /// Gives the twin the inputs that act in its next step. `begin`: stamp of t = 0 [ns].
  void feed(Twin& twin, Stamp begin)
  {
    // A torque of a profile can last for any time. The torque is commanded in every step, so that it does not time out.
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
  std::vector<Input> inputs_;  ///< inputs; their stamps count from t = 0 [ns]
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
      throw InputError(options.profile + " has a column 'load_torque'; remove --load");
    }
    profile.setLoad(*options.load);
  }
  return profile;
}

/// Writes one row for each message on joint_states.
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
  Stamp period_;  // time between two rows [ns]
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
  Twin twin(parameters, surfaceSource(readingWatch()));
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
    throw InputError(options.out + " would be empty, because the run of " +
                     shortNumber(toSeconds(end - summary.begin)) +
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
           "CSV file with columns time [s], motor_torque [N.m] and optionally load_torque [N.m], brake (0 or 1); each "
           "row is valid until the next")
      .type("FILE.csv");
  table.oneOf({ "--torque", "--profile" });
  table.add("--load", options.load, "constant external torque at the output; > 0 resists positive motion [N.m]");
  table.add("--out", options.out, "bag with the node's topics, or CSV file with a row for each message on joint_states")
      .required()
      .type("FILE.bag|FILE.csv")
      .endsIn({ ".bag", ".csv" });
  addNamespaceOption(table, options.joint_namespace);
  addFaultOption(table, options);
  addCommonOptions(table, options);
}

const Subcommand SIMULATE{ Subject::JOINT, "simulate", "run the twin under a given motor torque", declare, simulate };

/// Longest accepted recording [s]. A longer one has a damaged time, and the twin would simulate years.
constexpr double MAX_RECORDING = 1e6;

struct ReplayOptions : CommonOptions
{
  std::string bag;
  std::string out;
  std::string joint_namespace{ DEFAULT_NAMESPACE };
  bool without_command{};
};

/// Configuration of a replay: by default with the response surface, whose error is below the resolution of published
/// sensor values. A file or --set may select the full ring. Each Health message says which of the two was used.
ParameterMap replayedMap(const ReplayOptions& options)
{
  ParameterMap map = defaultParameterMap(options);
  readAssignment("solver.scene=auto", map);
  addOverlays(options, map);
  return map;
}

/// Whether the user names the joint, by a file or by --set.
bool jointIsChosen(const ReplayOptions& options, const ParameterMap& map)
{
  CommonOptions defaults;
  defaults.config_dir = options.config_dir;
  return map.at("joint.name").origin != loadParameterMap(defaults).at("joint.name").origin;
}

[[noreturn]] void failWithoutInputs(const rosbag::Bag& bag, const ReplayOptions& options, const BagInputs& found,
                                    const std::string& joint)
{
  if (!found.other_joints.empty())
  {
    throw InputError(options.bag + " contains commands for other joints (" + joined(found.other_joints) +
                     ") than joint.name = " + joint +
                     ". Choose one of these joints with --set joint.name=NAME or an overlay of config/joints");
  }
  throw InputError(options.bag + " has no motor torque on an input topic (" +
                   joined(inputTopics(options.joint_namespace)) +
                   "). --without-command replays the other inputs alone. `joint_twin follow --bag` follows the "
                   "motion of a robot. The bag holds these topics:" +
                   listTopics(bag));
}

/// Whether the bag can be replayed: it contains a motor torque or, with --without-command, any input of the twin.
bool suffices(const BagInputs& found, const ReplayOptions& options)
{
  return std::any_of(found.inputs.begin(), found.inputs.end(),
                     [&](const TwinInput& input)
                     {
                       const auto* value = std::get_if<Input>(&input);
                       return options.without_command || (value != nullptr && value->kind == InputKind::MOTOR_TORQUE);
                     });
}

/// Checks the length of the recording. @throws InputError if it exceeds MAX_RECORDING.
void checkSpan(const rosbag::Bag& bag, const std::string& path)
{
  rosbag::View view(bag);
  const double span = toSeconds(fromRosTime(view.getEndTime()) - fromRosTime(view.getBeginTime()));
  if (span > MAX_RECORDING)
  {
    throw InputError(path + ": the times of recording span " + shortNumber(span) + " s, allowed: at most " +
                     shortNumber(MAX_RECORDING) + " s; at least one of these times is damaged");
  }
}

/// Inputs of the bag. If the bag commands only one joint and the user has named no joint, `parameters` gets the name of
/// the commanded joint. @throws InputError if the bag contains nothing to replay.
BagInputs requireInputs(const rosbag::Bag& bag, const ReplayOptions& options, const ParameterMap& map,
                        Parameters& parameters)
{
  BagInputs found = readBagInputs(bag, options.joint_namespace, parameters);
  if (found.inputs.empty() && found.other_joints.size() == 1 && !jointIsChosen(options, map))
  {
    parameters.joint.name = *found.other_joints.begin();
    std::cerr << "joint_twin: joint.name = " << parameters.joint.name << ", the one joint that " << options.bag
              << " commands\n";
    found = readBagInputs(bag, options.joint_namespace, parameters);
  }
  if (!suffices(found, options))
  {
    failWithoutInputs(bag, options, found, parameters.joint.name);
  }
  warn(found.without_effort, "messages name " + parameters.joint.name + " without an effort; ignored");
  warn(found.damaged, "damaged messages on input topics; ignored");
  warn(found.refused_faults, "faults of unknown kind or with a value out of range; ignored");
  if (!found.other_joints.empty())
  {
    std::cerr << "joint_twin: the replay ignored messages for other joints: " << joined(found.other_joints) << '\n';
  }
  return found;
}

/// Runs a twin along a recording. Copies each recorded message after all simulated messages of earlier or equal time.
class Replay
{
public:
  Replay(const rosbag::Bag& bag, Twin& twin, const std::vector<TwinInput>& inputs, const ReplayOptions& options)
    : view_(bag), twin_(twin), inputs_(inputs), writer_(options.out), recorder_(twin, options.joint_namespace, writer_)
  {
    // The replay ends at the last time of recording, even if the stamp of the last input is later.
    end_ = fromRosTime(view_.getEndTime());
    begin_ = twin.stamp();
  }

  void run()
  {
    Progress progress("replaying");
    for (const rosbag::MessageInstance& message : view_)
    {
      advance(fromRosTime(message.getTime()), progress);
      if (interruptSignal() != 0)
      {
        break;
      }
      writer_.copy(message);
    }
    writer_.close();
  }

  bool isOpen() const { return writer_.isOpen(); }
  void close() { writer_.close(); }

private:
  void advance(Stamp until, Progress& progress)
  {
    feed();
    while (interruptSignal() == 0 && twin_.step(until))
    {
      recorder_.record(twin_);
      progress.update(static_cast<double>(twin_.stamp() - begin_) / static_cast<double>(end_ - begin_));
      feed();
    }
  }

  /// Gives the twin the recorded inputs that are due at the twin's next instant.
  void feed()
  {
    const Stamp instant = twin_.stamp() + twin_.stepLength();
    for (; next_ < inputs_.size() && stampOf(inputs_[next_]) <= instant; ++next_)
    {
      twin_.push(inputs_[next_]);
    }
  }

  rosbag::View view_;
  Twin& twin_;
  const std::vector<TwinInput>& inputs_;
  BagWriter writer_;
  BagRecorder recorder_;
  std::size_t next_{};
  Stamp begin_{};
  Stamp end_{};
};

int replay(const ReplayOptions& options)
{
  const ParameterMap map = replayedMap(options);
  Parameters parameters = parseParameters(map);
  addFaults(options, parameters);
  requireWritable(options.out, options.force, options.bag);
  rosbag::Bag bag;
  openForReading(bag, options.bag);
  refuseTopics(bag, options.bag, outputTopics(options.joint_namespace));
  checkSpan(bag, options.bag);
  const BagInputs found = requireInputs(bag, options, map, parameters);
  Twin twin(parameters, surfaceSource(readingWatch()));
  twin.watchSignals(true);
  twin.reset(stampOf(found.inputs.front()));
  const RunSummary summary{ options.out, twin.stamp() };
  const InterruptScope interrupts;
  Replay run(bag, twin, found.inputs, options);
  try
  {
    run.run();
  }
  catch (const std::exception& error)
  {
    if (!run.isOpen())
    {
      throw;  // the program could not write the output
    }
    run.close();
    throw InputError(options.bag + ": replay stopped: " + error.what() + "; " + options.out +
                     " is readable and contains the messages before the error");
  }
  return summary.report(twin, options.json);
}

void declare(OptionTable& table, ReplayOptions& options)
{
  table.add("bag", options.bag, "recording to replay").required().type("IN.bag");
  table.add("--out", options.out, "bag to write: the recording with the simulated topics added")
      .required()
      .type("OUT.bag")
      .endsIn({ ".bag" });
  table.flag("--without-command", options.without_command,
             "replay a bag without motor torque: only its load torques and faults");
  addNamespaceOption(table, options.joint_namespace);
  addFaultOption(table, options);
  addCommonOptions(table, options);
}

const Subcommand REPLAY{ Subject::RECORDING, "replay",
                         "run the twin along a bag; every original message is kept unchanged", declare, replay };
}  // namespace
}  // namespace hjt
