// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/configuration.hpp"

#include "health/signal_sample.hpp"
#include "messages/topics.hpp"

namespace hjt
{
/// Where in a recording the signals of the joint lie.
struct SignalSource
{
  // Columns of a CSV or HDF5 file, which must be there; empty: those of `joint_twin simulate` and of a data set.
  std::string time;
  std::string motor_torque;
  std::string motor_angle;
  std::string output_angle;
  std::string motor_velocity;
  std::string load_torque;
  std::string temperature;
  // Topics of a bag.
  std::string states_topic;
  std::string load_topic;
  bool load_topic_given{};        ///< then it must be there
  std::string joint;              ///< its name in both
  double torque_scale{ 1.0 };     ///< motor torque per unit of the recorded signal
  double velocity_window{ 0.0 };  ///< over which a data set's drive takes its motor speed, if that is not recorded [s]
};

/// Whether a column was named.
bool namesColumn(const SignalSource& source);

/// Gives every sample of a CSV file, a run of a data set (HDF5) or a bag to `take`, in order of time, until that
/// returns false.
/// CSV, HDF5: a column that is neither there nor named is not measured; time, torque and one angle must be. A data set
/// without the motor's speed gets it from its angle.
/// Bag: positions, velocities and efforts of NAME_motor and NAME in JointState messages; without NAME_motor the effort
/// of NAME, scaled, is the torque. Efforts of NAME on the load topic hold until the next.
/// @throws InputError
void readSignals(const std::string& path, const SignalSource& source,
                 const std::function<bool(const SignalSample&)>& take);

/// Recordings of one joint on the command line, and where in them its signals lie.
struct SignalOptions : CommonOptions
{
  std::vector<std::string> recordings;
  std::string joint_namespace{ DEFAULT_NAMESPACE };
  std::string joint;
  std::optional<std::string> states_topic;
  std::optional<std::string> load_topic;
  std::optional<double> torque_scale;
  SignalSource source;
};

void addSignalOptions(Command& command, SignalOptions& options);

/// What is wrong with the name of a recording; empty if nothing is.
std::string wrongSignalFile(const std::string& path);

/// Where the signals lie: a robot's telemetry if a joint was named, else what the twin publishes.
SignalSource signalSource(const SignalOptions& options, const Parameters& parameters);
}  // namespace hjt
