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

/// The recording of a joint or an arm, the parameters of its twins, and options for reading the recording.
struct RecordingOptions : ConfigurationOptions
{
  std::string recording;            ///< bag, .db3, .mcap, directory of ROS 2, or a controller's CSV file
  std::string joint;                ///< short name, such as base or shoulder, or the name in the messages
  std::string arm;                  ///< name of an arm in config/arms, or path of its file; empty: one joint
  std::string load{ LOAD_OF_ARM };  ///< load of an arm's joints: LOAD_OF_ARM or LOAD_RECORDED
  std::string identified;           ///< directory of overlays, SHORT_NAME.yaml; empty: no overlays
  std::string joint_namespace{ DEFAULT_NAMESPACE };  ///< namespace of the twin's topics
  std::string topic{ DEFAULT_TOPIC };                ///< topic of the telemetry in a bag
  JointAffixes affixes;                              ///< prefix and suffix of an arm's joint names in the messages
  double time_scale{ 1.0 };                          ///< factor by which the times of the rows are multiplied [-]
  bool force{};                                      ///< whether existing files are overwritten
  /// Recording in memory: a row of each joint at each time, with currents in A, from time 0 on. Null: a file is read.
  std::shared_ptr<const std::vector<std::vector<MotionRow>>> rows;
  bool rows_have_load{};
  /// What the recording states besides its rows: whether it has a load, gains and payload. Null: not yet read.
  std::shared_ptr<const RecordedStatements> stated;
  Watch watch;
};

/// Adds the options of `check`, which judges without a named joint and finds the arm if no option names it.
void addOptions(OptionTable& table, RecordingOptions& options);
// The next three functions each add a part of the options: the recording; joint, arm and reading; the twin's namespace.
void addRecordingOption(OptionTable& table, RecordingOptions& options);
void addJointOptions(OptionTable& table, RecordingOptions& options);
void addNamespaceOption(OptionTable& table, std::string& joint_namespace);

struct UrJoint
{
  int number{};      ///< number of the joint in the columns of a controller's recording, 0 to 5
  std::string name;  ///< name of the joint in the messages of UR's driver
};

/// Finds a joint by short name ("elbow"), name in the messages or number; none if it is not a joint of UR's robots.
std::optional<UrJoint> findUrJoint(const std::string& name);

/// The recording and the joint that the options name.
MotionSource motionSource(const RecordingOptions& options);
}  // namespace hjt
