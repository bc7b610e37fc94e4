// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/common/motion_options.hpp"

#include "arm/arm_load.hpp"
#include "arm/recording_fit.hpp"

namespace hjt
{
/// What subcommands on the recording of a whole arm take.
struct ArmOptions : MotionOptions
{
  std::string arm;         ///< name in config/arms, or a file; empty: one joint
  std::string load;        ///< arm or target_moment
  std::string identified;  ///< directory of overlays, SHORT_NAME.yaml; empty: none
};

/// `--arm` alone.
void addArmOption(Command& command, ArmOptions& options);

/// `--joint` or `--arm`, and what goes with them.
void addArmOptions(Command& command, ArmOptions& options);

/// One joint of the arm at the time of a row.
struct ArmJointRow
{
  MotionRow row;           ///< its load the one chosen, at the output
  double recorded_load{};  ///< [N.m]
  double motor_part{};     ///< what of the motor's inertia a controller's torque holds beside the arm's load [N.m]
};

/// The recording of an arm, and the twin's parameters of each of its joints.
class ArmRecording
{
public:
  /// @throws ParameterError, InputError: unreadable, or without the load that is chosen.
  explicit ArmRecording(const ArmOptions& options);

  const ArmDescription& arm() const { return arm_; }
  const std::vector<ArmJoint>& joints() const { return arm_.joints; }
  MotionSource source(std::size_t joint) const;  ///< of that joint alone
  /// `telemetry.inertia_in_load` is that of the load that is chosen.
  const Parameters& parameters(std::size_t joint) const { return parameters_[joint]; }
  const std::vector<Parameters>& parameters() const { return parameters_; }
  bool hasRecordedLoad() const { return has_load_; }
  /// The load is the recorded one.
  bool usesRecordedLoad() const { return uses_recorded_; }

  /// Calls `visit` for each time with a row of each joint, in memory that does not grow, and prints to stderr what does
  /// not fit. @throws InputError.
  MotionFindings read(const std::function<void(const std::vector<ArmJointRow>&)>& visit) const;
  /// The same without printing; `fit` receives all rows.
  MotionFindings read(const std::function<void(const std::vector<ArmJointRow>&)>& visit, RecordingFit& fit) const;
  /// Prints to stderr why a joint cannot be judged. Wrong stamps are reported by warnOfStamps.
  void warnOf(const RecordingFit& fit) const;

private:
  MotionSource source_;
  ArmDescription arm_;
  std::vector<Parameters> parameters_;
  std::vector<double> inertias_in_load_;  // of the motors, in a controller's torque, at the joints [kg.m^2]
  bool has_load_;
  bool uses_recorded_;
};
}  // namespace hjt
