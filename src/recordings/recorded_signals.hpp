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
/// Recordings of one joint, the parameters of its twin, and the columns or topics of its signals.
struct SignalOptions : ConfigurationOptions
{
  std::vector<std::string> recordings;
  /// Columns of each recording that is in memory, by the recording's name. A recording without an entry is a file.
  std::map<std::string, Columns> at_hand;
  std::string joint_namespace{ DEFAULT_NAMESPACE };
  std::string joint;  ///< joint of a robot whose telemetry a bag holds; empty: the bag is of the twin
  std::optional<std::string> states_topic;
  std::optional<std::string> load_topic;
  std::optional<double> torque_scale;  ///< motor torque per unit of the recorded signal [N.m]
  /// Names of columns of a CSV or HDF5 file, in the order of the signals. An empty name stands for the name that
  /// `joint_twin simulate` and data sets use.
  std::array<std::string, 8> columns;
  bool force{};  ///< whether existing files are overwritten
  Watch watch;
};

void addSignalOptions(OptionTable& table, SignalOptions& options);

bool namesColumn(const SignalOptions& options);
/// Sets the column of a signal. `signal` is the name of the tool's option without dashes: "motor_torque" for
/// --motor-torque. @throws InputError that lists the signals.
void nameColumn(SignalOptions& options, const std::string& signal, const std::string& column);

/// Calls `take` with each sample of a recording in order of time, until `take` returns false. The recording is in
/// memory, a CSV file, a run of a data set (HDF5) or a bag.
/// Columns for time, torque and one angle must exist. A signal without a column counts as not measured. In memory and
/// in a data set, a motor speed that is not recorded is computed from the motor angle.
/// From a bag, positions, velocities and efforts of NAME_motor and NAME in JointState messages are read. Without
/// NAME_motor, the scaled effort of NAME is the torque. An effort of NAME on the load topic holds until the next
/// message.
/// @throws InputError if the recording is unreadable, or if a column, topic or joint is missing.
void readSignals(const std::string& recording, const SignalOptions& options, const Parameters& parameters,
                 const std::function<bool(const SignalSample&)>& take);

/// Clause on what is wrong with the name of a recording; empty if the name is valid.
std::string wrongSignalFile(const std::string& path);
}  // namespace hjt
