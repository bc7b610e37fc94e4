// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recorded_signals.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "datasets/run_file.hpp"
#include "recordings/recording_options.hpp"

#include "bags/bag_file.hpp"
#include "bags/message_decoder.hpp"
#include "base/csv_table.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/conversions.hpp"
#include "messages/time.hpp"

namespace hjt
{
namespace
{
/// Detects times that are not in seconds: steps of RARE or more, or a motor speed that contradicts the motor angle.
class SecondsCheck
{
public:
  void add(const SignalSample& sample)
  {
    const double step = 1e-9 * (static_cast<double>(sample.stamp) - static_cast<double>(last_.stamp));
    const double turn = sample.motor_velocity * (sample.motor_angle - last_.motor_angle);
    if (step > 0.0 && steps_++ > 0)
    {
      rare_ += step >= RARE ? 1 : 0;
      if (std::isfinite(turn))
      {
        by_angle_ += turn;
        by_speed_ += sample.motor_velocity * sample.motor_velocity * step;
      }
    }
    if (std::isfinite(sample.motor_angle))
    {
      least_ = std::min(least_, sample.motor_angle);
      most_ = std::max(most_, sample.motor_angle);
    }
    last_ = sample;
  }

  /// Clause on why the times are probably not in seconds; empty if they seem to be in seconds.
  std::string doubt() const
  {
    constexpr double TURN = 2.0 * M_PI;  // least motion of the motor that is more than noise [rad]
    // Least ratio of the motion that follows from speed and time to the motion of the recorded angle [-]. A wrong unit
    // of the speed causes a smaller ratio, times in milliseconds cause a larger one.
    constexpr double FACTOR = 100.0;
    if (2 * rare_ > steps_)
    {
      return "most samples are " + numberText(RARE) + " s apart or more";
    }
    return most_ - least_ > TURN && by_angle_ > 0.0 && by_speed_ > FACTOR * by_angle_ ?
               "the recorded motor speed gives " + fixedText(by_speed_ / by_angle_, 0) +
                   " times the motion of the recorded motor angle" :
               "";
  }

private:
  static constexpr double RARE = 0.5;  // least step that is too long to show a motion [s]

  SignalSample last_;
  std::uint64_t steps_{};
  std::uint64_t rare_{};      // number of steps of RARE or more
  double by_angle_{};         // sum of speed times change of angle [rad^2/s]
  double by_speed_{};         // sum of squared speed times time step [rad^2/s]
  double least_{ HUGE_VAL };  // least angle of the motor [rad]
  double most_{ -HUGE_VAL };  // largest angle of the motor [rad]
};

using Take = std::function<bool(const SignalSample&)>;

enum Column : std::size_t
{
  TIME,
  MOTOR_TORQUE,
  MOTOR_ANGLE,
  OUTPUT_ANGLE,
  MOTOR_VELOCITY,
  LOAD_TORQUE,
  TEMPERATURE,
  TARGET_ANGLE,
  COLUMNS
};

using Names = std::array<std::string, COLUMNS>;

/// Option that names the column of a signal, and default names of this column in a file.
struct ColumnChoice
{
  const char* option;
  const char* meaning;
  double SignalSample::*field;  // null for the time
  const char* name;
  const char* otherwise{};  // second default, used if the file has no column `name`
};
constexpr std::array<ColumnChoice, COLUMNS> CHOICES{
  { { "--time", "time [s]", nullptr, "time" },
    { "--motor-torque", "motor torque [N.m], or motor current [A] with --torque-scale", &SignalSample::motor_torque,
      "motor_torque_reading", "motor_torque" },
    { "--motor-angle", "motor encoder [rad]", &SignalSample::motor_angle, "motor_angle_encoder" },
    { "--output-angle", "output encoder [rad]", &SignalSample::output_angle, "output_angle_encoder" },
    { "--motor-velocity", "motor speed [rad/s]; if missing, from the motor angle", &SignalSample::motor_velocity,
      "motor_velocity_encoder" },
    { "--load-torque", "load torque at the output, > 0 resists positive motion [N.m]", &SignalSample::load_torque,
      "load_torque" },
    { "--temperature", "temperature [degC]", &SignalSample::temperature, "housing_temperature", "temperature" },
    { "--target-angle", "set point of the output angle [rad]", &SignalSample::target_angle, "target_angle" } }
};

/// Columns or topics of a recording with the signals of the joint.
struct SignalSource
{
  Names columns;
  // The following members are used for a bag only.
  std::string states_topic;
  std::string load_topic;
  bool load_topic_given{};        // whether the user named the topic; if so, the topic must exist
  std::string joint;              // name of the joint on the topics of states and load
  double torque_scale{ 1.0 };     // motor torque per unit of the recorded signal [N.m]
  double velocity_window{ 0.0 };  // time window over which a motor speed is computed [s]
};

/// Names of the columns of a file, in the order of the signals. `place` is the file and line for an error text.
/// @throws InputError if a column that the user named, or a required column, does not exist.
Names columnsOf(const std::string& place, const std::vector<std::string>& there, const Names& columns)
{
  Names names;
  for (std::size_t i = 0; i < COLUMNS; ++i)
  {
    const ColumnChoice& choice = CHOICES[i];
    const std::string& given = columns[i];
    if (!given.empty() && !holds(there, given))
    {
      throw InputError(place + ": " + choice.option + " " + given + ": no such column" + didYouMean(given, there) +
                       "; it holds " + joined(there, ", "));
    }
    const bool is_named_so = choice.otherwise == nullptr || holds(there, choice.name);
    names[i] = !given.empty() ? given : is_named_so ? choice.name : choice.otherwise;
  }
  for (const Column column : { MOTOR_TORQUE, TIME })
  {
    if (!holds(there, names[column]))
    {
      throw InputError(place + ": column '" + names[column] + "' is missing. Name another column with " +
                       CHOICES[column].option + ". The file has the columns " + joined(there, ", "));
    }
  }
  if (!holds(there, names[MOTOR_ANGLE]) && !holds(there, names[OUTPUT_ANGLE]))
  {
    throw InputError(place + ": the file has neither column '" + names[MOTOR_ANGLE] + "' nor column '" +
                     names[OUTPUT_ANGLE] +
                     "'. Name a column of an angle with --motor-angle or --output-angle. The file has the columns " +
                     joined(there, ", "));
  }
  return names;
}

SignalSample sampleOf(const std::array<double, COLUMNS>& row, double torque_scale)
{
  SignalSample sample;
  sample.stamp = static_cast<std::int64_t>(std::llround(1e9 * row[TIME]));
  for (std::size_t i = TIME + 1; i < COLUMNS; ++i)
  {
    sample.*CHOICES[i].field = row[i];
  }
  sample.motor_torque *= torque_scale;
  return sample;
}

/// Motor speed, computed as in the drive's own sensors: the change of the angle per time over `window` [s]. Samples
/// within the first window have the speed of that window.
std::vector<double> velocityOf(const std::vector<double>& time, const std::vector<double>& angle, double window)
{
  std::vector<double> velocity(time.size(), NOT_MEASURED);
  const double period = time.size() > 1 ? time[1] - time[0] : 1.0;
  const auto steps = static_cast<std::size_t>(std::max(std::lround(window / period), 1L));
  for (std::size_t end = steps; end < time.size(); ++end)
  {
    velocity[end] = (angle[end] - angle[end - steps]) / (time[end] - time[end - steps]);
  }
  std::fill_n(velocity.begin(), std::min(steps, time.size()), steps < time.size() ? velocity[steps] : NOT_MEASURED);
  return velocity;
}

void readTable(const std::string& path, const SignalSource& source, const Take& take)
{
  NumberTable<COLUMNS> table(path, columnsOf(path + ":1", CsvRows(path).header(), source.columns),
                             COLUMNS - MOTOR_ANGLE);
  std::array<double, COLUMNS> row{};
  row.fill(NOT_MEASURED);
  while (table.read(row) && take(sampleOf(row, source.torque_scale)))
  {
  }
}

/// Reads columns in memory. `place` names the recording in the text of an error.
void readColumns(const std::string& place, Columns columns, const SignalSource& source, const Take& take)
{
  std::vector<std::string> there;
  std::transform(columns.begin(), columns.end(), std::back_inserter(there),
                 [](const auto& item) { return item.first; });
  const Names names = columnsOf(place, there, source.columns);
  if (columns.count(names[MOTOR_VELOCITY]) == 0 && columns.count(names[MOTOR_ANGLE]) > 0)
  {
    columns[names[MOTOR_VELOCITY]] =
        velocityOf(columns.at(names[TIME]), columns.at(names[MOTOR_ANGLE]), source.velocity_window);
  }
  std::array<double, COLUMNS> row{};
  row.fill(NOT_MEASURED);
  for (std::size_t i = 0; i < columns.at(names[TIME]).size(); ++i)
  {
    for (std::size_t column = 0; column < COLUMNS; ++column)
    {
      const auto found = columns.find(names[column]);
      row[column] = found != columns.end() ? found->second[i] : NOT_MEASURED;
    }
    if (!take(sampleOf(row, source.torque_scale)))
    {
      return;
    }
  }
}

void readRun(const std::string& path, const SignalSource& source, const Take& take)
{
  const ColumnChoice& torque = CHOICES[MOTOR_TORQUE];
  const std::string& named = source.columns[MOTOR_TORQUE];
  Columns columns = readRunColumns(path, named.empty() ? std::vector<std::string>{ torque.name, torque.otherwise } :
                                                         std::vector<std::string>{ named });
  if (columns.empty())
  {
    columns = readRunColumns(path, { CHOICES[TIME].name });  // for an error text that lists the columns of the file
  }
  readColumns(path, std::move(columns), source, take);
}

double entry(const std::vector<double>& values, std::size_t place)
{
  return place < values.size() ? values[place] : NOT_MEASURED;
}

SignalSample sampleOf(const sensor_msgs::JointState& state, const JointNames& names, double torque_scale)
{
  const auto motor = placeOf(state, names.motor);
  const auto joint = placeOf(state, names.joint);
  SignalSample sample;
  sample.stamp = fromRosTime(state.header.stamp);
  sample.motor_angle = entry(state.position, motor);
  sample.motor_velocity = entry(state.velocity, motor);
  sample.output_angle = entry(state.position, joint);
  sample.motor_torque = torque_scale * entry(state.effort, motor < state.name.size() ? motor : joint);
  return sample;
}

void readBag(const std::string& path, const SignalSource& source, const Take& take)
{
  for (std::size_t i = 0; i < COLUMNS; ++i)
  {
    if (!source.columns[i].empty())
    {
      throw InputError(path + " is a bag: " + CHOICES[i].option + " " + source.columns[i] + " names a column");
    }
  }
  rosbag::Bag bag;
  openForReading(bag, path);
  const JointNames names(source.joint);
  rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{ source.states_topic, source.load_topic }));
  CheckedMessage checked;
  double load = NOT_MEASURED;
  std::uint64_t samples = 0;
  if (source.load_topic_given && rosbag::View(bag, rosbag::TopicQuery(source.load_topic)).size() == 0)
  {
    throw InputError(path + " has no topic " + source.load_topic + "; it holds:" + listTopics(bag));
  }
  for (const rosbag::MessageInstance& message : view)
  {
    if (!checked.read(message))
    {
      continue;
    }
    const sensor_msgs::JointState& state = checked.state();
    if (message.getTopic() == source.load_topic)
    {
      readLoadTorque(state, names, load);
    }
    else if (std::min(placeOf(state, names.joint), placeOf(state, names.motor)) < state.name.size())
    {
      SignalSample sample = sampleOf(state, names, source.torque_scale);
      sample.load_torque = load;
      ++samples;
      if (!take(sample))
      {
        return;
      }
    }
  }
  if (samples == 0)
  {
    throw InputError(path + " has no state of " + source.joint + " on " + source.states_topic +
                     "; it holds:" + listTopics(bag));
  }
}
/// Columns and topics of the signals: those of a robot's telemetry if a joint was named, else those of the twin.
SignalSource signalSource(const SignalOptions& options, const Parameters& parameters)
{
  const bool robot = !options.joint.empty();
  const double scale = options.torque_scale.value_or(1.0);
  if (scale == 0.0 || !std::isfinite(scale))
  {
    throw InputError("torque_scale = " + numberText(scale) + " must be a finite number other than 0");
  }
  const std::optional<UrJoint> known = findUrJoint(options.joint);
  SignalSource source;
  source.columns = options.columns;
  source.joint = known ? known->name : robot ? options.joint : parameters.joint.name;
  source.states_topic =
      options.states_topic.value_or(robot ? "/joint_states" : options.joint_namespace + "/" + topics::JOINT_STATES);
  source.load_topic = options.load_topic.value_or(options.joint_namespace + "/" + topics::LOAD);
  source.load_topic_given = options.load_topic.has_value();
  source.velocity_window = parameters.sensors.velocity_window;
  source.torque_scale = options.torque_scale.value_or(
      robot ? parameters.telemetry.torque_per_current / nominalRatio(parameters.gear) : 1.0);
  return source;
}
}  // namespace

bool namesColumn(const SignalOptions& options)
{
  return options.columns != Names();
}

void nameColumn(SignalOptions& options, const std::string& signal, const std::string& column)
{
  std::vector<std::string> signals;
  for (std::size_t i = 0; i < COLUMNS; ++i)
  {
    std::string name = CHOICES[i].option + 2;  // without the dashes of the option
    std::replace(name.begin(), name.end(), '-', '_');
    if (name == signal)
    {
      options.columns[i] = column;
      return;
    }
    signals.push_back(name);
  }
  throw InputError("columns: '" + signal + "' is no signal" + didYouMean(signal, signals) + "; there are " +
                   joined(signals, ", "));
}

void addSignalOptions(OptionTable& table, SignalOptions& options)
{
  table
      .add("recordings", options.recordings,
           "one recording, or several of the same joint; a run of a data set (HDF5) has its own parameters, which "
           "--config and --set override")
      .required()
      .type("IN.csv|IN.bag|IN.h5")
      .check([&options](const std::string& path)
             { return options.at_hand.count(path) > 0 ? std::string() : wrongSignalFile(path); });
  table.add("--joint", options.joint,
            "bag: joint of a robot on /joint_states, whose effort is the current in A: base, shoulder, "
            "elbow, wrist_1 ..., or its name in the messages; default: the joint of the twin");
  for (std::size_t i = 0; i < COLUMNS; ++i)
  {
    const ColumnChoice& choice = CHOICES[i];
    const std::string otherwise = choice.otherwise == nullptr ? "" : std::string(", else ") + choice.otherwise;
    const std::string help = std::string("CSV, HDF5: ") + choice.meaning + "; default: " + choice.name + otherwise;
    table.add(choice.option, options.columns[i], help).type("COLUMN");
  }
  table.add("--torque-scale", options.torque_scale,
            "motor torque per unit of the recorded signal [N.m]; default: 1, but with --joint "
            "telemetry.torque_per_current / ratio [N.m/A]");
  table
      .add("--states-topic", options.states_topic,
           "bag: topic of JointState messages; default: NAMESPACE/joint_states, and with --joint /joint_states")
      .type("TOPIC");
  table.add("--load-topic", options.load_topic, "bag: topic of the load torque; default: NAMESPACE/load").type("TOPIC");
  addNamespaceOption(table, options.joint_namespace);
}

void readSignals(const std::string& recording, const SignalOptions& options, const Parameters& parameters,
                 const Take& take)
{
  const SignalSource source = signalSource(options, parameters);
  SecondsCheck seconds;
  const Take check = [&](const SignalSample& sample)
  {
    seconds.add(sample);
    return take(sample);
  };
  const std::string extension = std::filesystem::path(recording).extension().string();
  const auto read = extension == ".bag" ? readBag : extension == ".h5" ? readRun : readTable;
  const auto at_hand = options.at_hand.find(recording);
  at_hand != options.at_hand.end() ? readColumns(recording, at_hand->second, source, check) :
                                     read(recording, source, check);
  if (const std::string doubt = seconds.doubt(); !doubt.empty())
  {
    throw InputError(recording + ": " + doubt + ", so the times are probably not in seconds");
  }
}

std::string wrongSignalFile(const std::string& path)
{
  const std::string ending = std::filesystem::path(path).extension().string();
  return ending == ".bag" || ending == ".csv" || ending == ".h5" ? "" : "'" + path + "' must end in .bag, .csv or .h5";
}
}  // namespace hjt
