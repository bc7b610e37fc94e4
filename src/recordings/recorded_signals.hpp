// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
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
/// Recordings of one joint, the parameters of its twin, and the places of its signals in the recordings.
struct SignalOptions : ConfigurationOptions
{
  std::vector<std::string> recordings;
  /// Columns of recordings in memory, by the recordings' names. Recordings that are not here are files.
  std::map<std::string, Columns> at_hand;
  std::string joint_namespace{ DEFAULT_NAMESPACE };
  std::string joint;  ///< joint of a robot, whose telemetry a bag holds; empty: the twin's own
  std::optional<std::string> states_topic;
  std::optional<std::string> load_topic;
  std::optional<double> torque_scale;  ///< motor torque per unit of the recorded signal [N.m]
  /// Names of columns of a CSV or HDF5 file, in the order of the signals. An empty name stands for the column of
  /// `joint_twin simulate` and of a data set.
  std::array<std::string, 8> columns;
  bool force{};  ///< overwrite files
  Watch watch;
};

void addSignalOptions(OptionTable& table, SignalOptions& options);

/// Whether the options name a column.
bool namesColumn(const SignalOptions& options);
/// Sets the column of a signal, which is named as the tool's option: "motor_torque" for --motor-torque. @throws
/// InputError naming the signals.
void nameColumn(SignalOptions& options, const std::string& signal, const std::string& column);

/// Gives every sample of a recording to `take`, in order of time, until `take` returns false. The recording is in
/// memory, a CSV file, a run of a data set (HDF5) or a bag.
/// Columns for time, torque and one angle must exist; a signal without a column counts as not measured. In memory and
/// in a data set a motor speed that is not recorded is computed from the angle.
/// Of a bag the function takes positions, velocities and efforts of NAME_motor and NAME in JointState messages. Without
/// NAME_motor the scaled effort of NAME is the torque. An effort of NAME on the load topic holds until the next one.
/// @throws InputError
void readSignals(const std::string& recording, const SignalOptions& options, const Parameters& parameters,
                 const std::function<bool(const SignalSample&)>& take);

/// Says what is wrong with the name of a recording; empty if nothing is.
std::string wrongSignalFile(const std::string& path);
}  // namespace hjt
