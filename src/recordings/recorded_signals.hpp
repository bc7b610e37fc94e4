// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/run_file.hpp"
#include "output/progress.hpp"

#include "health/signal_monitor.hpp"
#include "messages/topics.hpp"
#include "twin/options.hpp"

namespace hjt
{
/// Columns or topics of a recording with the signals of the joint.
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
  std::string target_angle;
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

/// Names the column of a signal: "motor_torque", as the tool's --motor-torque. @throws InputError naming the signals.
void nameColumn(SignalSource& source, const std::string& signal, const std::string& column);

/// Recordings of one joint, the parameters of its twin, and where in them its signals lie.
struct SignalOptions : ConfigurationOptions
{
  std::vector<std::string> recordings;
  /// Columns of recordings that are at hand, by their names above, all of one length; the others are files.
  std::map<std::string, Columns> at_hand;
  std::string joint_namespace{ DEFAULT_NAMESPACE };
  std::string joint;  ///< of a robot, whose telemetry a bag holds; empty: the twin's own
  std::optional<std::string> states_topic;
  std::optional<std::string> load_topic;
  std::optional<double> torque_scale;  ///< motor torque per unit of the recorded signal [N.m]
  SignalSource source;                 ///< columns
  bool force{};                        ///< overwrite files
  Watch watch;
};

void addSignalOptions(OptionTable& table, SignalOptions& options);

/// Gives every sample of a recording at hand, a CSV file, a run of a data set (HDF5) or a bag to `take`, in order of
/// time, until that returns false.
/// At hand, CSV, HDF5: a column that is neither there nor named is not measured; time, torque and one angle must be. At
/// hand and in a data set the motor's speed, if it is not there, comes from its angle.
/// Bag: positions, velocities and efforts of NAME_motor and NAME in JointState messages; without NAME_motor the effort
/// of NAME, scaled, is the torque. Efforts of NAME on the load topic hold until the next.
/// @throws InputError
void readSignals(const std::string& recording, const SignalOptions& options, const Parameters& parameters,
                 const std::function<bool(const SignalSample&)>& take);

/// What is wrong with the name of a recording; empty if nothing is.
std::string wrongSignalFile(const std::string& path);
}  // namespace hjt
