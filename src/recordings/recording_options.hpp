// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "output/progress.hpp"
#include "recordings/controller_table.hpp"
#include "recordings/recorded_motion.hpp"

#include "messages/joint_affixes.hpp"
#include "messages/topics.hpp"
#include "twin/options.hpp"

namespace hjt
{
constexpr const char* DEFAULT_TOPIC = "/joint_states";
constexpr const char* LOAD_OF_ARM = "arm";
constexpr const char* LOAD_RECORDED = "target_moment";

/// The recording of a joint or an arm, the parameters of its twins, and how it is read.
struct RecordingOptions : ConfigurationOptions
{
  std::string recording;                             ///< bag, .db3, .mcap, their directory, or a controller's CSV
  std::string joint;                                 ///< base, shoulder ..., or its name in the messages
  std::string arm;                                   ///< name in config/arms, or a file; empty: one joint
  std::string load{ LOAD_OF_ARM };                   ///< of an arm's joints: that or LOAD_RECORDED
  std::string identified;                            ///< directory of overlays, SHORT_NAME.yaml; empty: none
  std::string joint_namespace{ DEFAULT_NAMESPACE };  ///< of the twin's topics
  std::string topic{ DEFAULT_TOPIC };                ///< of the telemetry in a bag
  JointAffixes affixes;                              ///< of an arm's joints in the messages
  double time_scale{ 1.0 };                          ///< multiplies the times of the rows
  bool force{};                                      ///< overwrite files
  /// A recording at hand: a row of each joint at each time, currents in A, times from 0 on; null: it is a file.
  std::shared_ptr<const std::vector<std::vector<MotionRow>>> rows;
  bool rows_have_load{};
  /// By the recording, besides its rows; null: not read yet.
  std::shared_ptr<const RecordedStatements> stated;
  Watch watch;
};

/// Those of `check`, which finds the arm by itself.
void addOptions(OptionTable& table, RecordingOptions& options);
/// The recording alone; `--joint` or `--arm` and what goes with them, and how it is read.
void addRecordingOption(OptionTable& table, RecordingOptions& options);
void addJointOptions(OptionTable& table, RecordingOptions& options);
void addNamespaceOption(OptionTable& table, std::string& joint_namespace);

/// A joint of UR's robots: its place in the columns of a controller's recording.
struct UrJoint
{
  int number{};      ///< 0 ... 5
  std::string name;  ///< in the messages of UR's driver
};

/// By short name ("elbow"), name in the messages or number; none: not a joint of UR's robots.
std::optional<UrJoint> findUrJoint(const std::string& name);

/// The recording and joint they name.
MotionSource motionSource(const RecordingOptions& options);
}  // namespace hjt
