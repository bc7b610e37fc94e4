// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tool/recorded_signals.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "base/number_table.hpp"
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

void readTable(const std::string& path, const SignalSource& source, const Take& take)
{
  NumberTable<COLUMNS> table(path,
                             { source.time, source.motor_torque, source.motor_angle, source.output_angle,
                               source.motor_velocity, source.load_torque, source.temperature },
                             COLUMNS - MOTOR_ANGLE);
  if (!table.hasColumn(MOTOR_ANGLE) && !table.hasColumn(OUTPUT_ANGLE))
  {
    throw InputError(path + ":1: neither column '" + source.motor_angle + "' nor '" + source.output_angle +
                     "' is there; name one with --motor-angle or --output-angle");
  }
  std::array<double, COLUMNS> row{};
  row.fill(NOT_MEASURED);
  while (table.read(row))
  {
    SignalSample sample;
    sample.stamp = static_cast<std::int64_t>(std::llround(1e9 * row[TIME]));
    sample.motor_angle = row[MOTOR_ANGLE];
    sample.output_angle = row[OUTPUT_ANGLE];
    sample.motor_velocity = row[MOTOR_VELOCITY];
    sample.motor_torque = source.torque_scale * row[MOTOR_TORQUE];
    sample.load_torque = row[LOAD_TORQUE];
    sample.temperature = row[TEMPERATURE];
    if (!take(sample))
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
  if (std::filesystem::path(path).extension() == ".bag")
  {
    readBag(path, source, take);
  }
  else
  {
    readTable(path, source, take);
  }
}
}  // namespace hjt
