// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tool/recorded_signals.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "apps/common/motion_options.hpp"
#include "apps/sweep/run_file.hpp"

#include "base/number_table.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "ros_io/bag_file.hpp"
#include "ros_io/checked_message.hpp"
#include "ros_io/conversions.hpp"
#include "ros_io/time.hpp"

namespace hjt
{
namespace
{
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
  COLUMNS
};

using Names = std::array<std::string, COLUMNS>;

/// The columns of a file in the order of the signals. `has(name)`: whether it has one of this name.
template <class Has>
Names columnsOf(const SignalSource& source, const Has& has)
{
  const auto given = [&](const std::string& name, const char* reading, const char* otherwise) {
    return !name.empty() ? name : has(reading) ? reading : otherwise;
  };
  return { source.time,
           given(source.motor_torque, "motor_torque_reading", "motor_torque"),
           source.motor_angle,
           source.output_angle,
           source.motor_velocity,
           source.load_torque,
           given(source.temperature, "housing_temperature", "temperature") };
}

void requireAngle(bool there, const std::string& place, const SignalSource& source)
{
  if (!there)
  {
    throw InputError(place + ": neither column '" + source.motor_angle + "' nor '" + source.output_angle +
                     "' is there; name one with --motor-angle or --output-angle");
  }
}

SignalSample sampleOf(const std::array<double, COLUMNS>& row, double torque_scale)
{
  SignalSample sample;
  sample.stamp = static_cast<std::int64_t>(std::llround(1e9 * row[TIME]));
  sample.motor_angle = row[MOTOR_ANGLE];
  sample.output_angle = row[OUTPUT_ANGLE];
  sample.motor_velocity = row[MOTOR_VELOCITY];
  sample.motor_torque = torque_scale * row[MOTOR_TORQUE];
  sample.load_torque = row[LOAD_TORQUE];
  sample.temperature = row[TEMPERATURE];
  return sample;
}

void readTable(const std::string& path, const SignalSource& source, const Take& take)
{
  std::ifstream file(path);
  std::string header;
  std::getline(file, header);
  header = "," + header.substr(0, header.find('\r')) + ",";
  const auto has = [&](const std::string& name) { return header.find("," + name + ",") != std::string::npos; };
  NumberTable<COLUMNS> table(path, columnsOf(source, has), COLUMNS - MOTOR_ANGLE);
  requireAngle(table.hasColumn(MOTOR_ANGLE) || table.hasColumn(OUTPUT_ANGLE), path + ":1", source);
  std::array<double, COLUMNS> row{};
  row.fill(NOT_MEASURED);
  while (table.read(row) && take(sampleOf(row, source.torque_scale)))
  {
  }
}

/// A run of a data set.
void readRun(const std::string& path, const SignalSource& source, const Take& take)
{
  const std::vector<std::string> torques = source.motor_torque.empty() ?
                                               std::vector<std::string>{ "motor_torque_reading", "motor_torque" } :
                                               std::vector<std::string>{ source.motor_torque };
  const Columns columns = readRunColumns(path, torques);
  const Names names = columnsOf(source, [&](const std::string& name) { return columns.count(name) > 0; });
  for (const Column column : { MOTOR_TORQUE, TIME })
  {
    if (columns.count(names[column]) == 0)
    {
      throw InputError(path + ": column '" + names[column] + "' is missing");
    }
  }
  requireAngle(columns.count(names[MOTOR_ANGLE]) + columns.count(names[OUTPUT_ANGLE]) > 0, path, source);
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
  rosbag::Bag bag;
  openForReading(bag, path);
  const JointNames names(source.joint);
  rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{ source.states_topic, source.load_topic }));
  CheckedMessage checked;
  double load = NOT_MEASURED;
  std::uint64_t samples = 0;
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
}  // namespace

void readSignals(const std::string& path, const SignalSource& source, const Take& take)
{
  const std::string extension = std::filesystem::path(path).extension().string();
  const auto read = extension == ".bag" ? readBag : extension == ".h5" ? readRun : readTable;
  read(path, source, take);
}

SignalSource signalSource(const SignalOptions& options, const Parameters& parameters)
{
  const bool robot = !options.joint.empty();
  const std::optional<UrJoint> known = findUrJoint(options.joint);
  SignalSource source = options.source;
  source.joint = known ? known->name : robot ? options.joint : parameters.joint.name;
  source.states_topic =
      options.states_topic.value_or(robot ? "/joint_states" : options.joint_namespace + "/" + topics::JOINT_STATES);
  source.load_topic = options.load_topic.value_or(options.joint_namespace + "/" + topics::LOAD);
  source.torque_scale = options.torque_scale.value_or(
      robot ? parameters.telemetry.torque_per_current / nominalRatio(parameters.gear) : 1.0);
  return source;
}

std::string wrongSignalFile(const std::string& path)
{
  const std::string ending = std::filesystem::path(path).extension().string();
  return ending == ".bag" || ending == ".csv" || ending == ".h5" ? "" : "'" + path + "' must end in .bag, .csv or .h5";
}

void addSignalOptions(Command& command, SignalOptions& options)
{
  command.add("recordings", options.recordings, "one recording, or several of the same joint")
      .required()
      .type("IN.csv|IN.bag|IN.h5")
      .check(wrongSignalFile);
  command.add("--joint", options.joint,
              "bag: a robot's joint on /joint_states, effort in A, by telemetry.torque_per_current: base, shoulder, "
              "elbow, wrist_1 ..., or its name in the messages; default: the twin's own");
  SignalSource& source = options.source;
  const auto column = [&command](const char* name, std::string& field, const char* meaning)
  { command.add(name, field, meaning).type("COLUMN"); };
  column("--time", source.time, "CSV, HDF5: time [s]");
  column("--motor-torque", source.motor_torque,
         "CSV, HDF5: motor torque, or current with --torque-scale; default: motor_torque_reading, else "
         "motor_torque");
  column("--motor-angle", source.motor_angle, "CSV, HDF5: motor encoder [rad]");
  column("--output-angle", source.output_angle, "CSV, HDF5: output encoder [rad]");
  column("--motor-velocity", source.motor_velocity, "CSV, HDF5: motor speed [rad/s]; else differences of the angle");
  column("--load-torque", source.load_torque,
         "CSV, HDF5: load torque at the output, > 0 resists positive motion [N.m]");
  column("--temperature", source.temperature,
         "CSV, HDF5: temperature [degC]; default: housing_temperature, else temperature");
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
}  // namespace hjt
