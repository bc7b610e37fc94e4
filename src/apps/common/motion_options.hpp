// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "apps/common/configuration.hpp"

#include "messages/joint_affixes.hpp"
#include "recordings/recorded_motion.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
/// What subcommands on the measured motion of a joint take.
struct MotionOptions : CommonOptions
{
  std::string recording;
  std::string joint;
  std::string joint_namespace;
  std::string topic;
  JointAffixes affixes;  ///< of an arm's joints in the messages
  double time_scale{ 1.0 };
};

/// A joint of UR's robots: its place in the columns of a controller's recording.
struct UrJoint
{
  int number{};      ///< 0 ... 5
  std::string name;  ///< in the messages of UR's driver
};

/// By short name ("elbow"), name in the messages or number; none: not a joint of UR's robots.
std::optional<UrJoint> findUrJoint(const std::string& name);

constexpr const char* DEFAULT_TOPIC = "/joint_states";

/// Those but the joint: the recording itself, then how it is read.
void addRecording(Command& command, MotionOptions& options);
void addReadingOptions(Command& command, MotionOptions& options);

/// `addMotionOptions` leaves `--joint` no choice.
void addRecordingOptions(Command& command, MotionOptions& options);
void addMotionOptions(Command& command, MotionOptions& options);

/// The recording and joint they name.
MotionSource motionSource(const MotionOptions& options);

/// Says on stderr if stamps and angles of a joint disagree with the recorded velocities.
void warnOfStamps(const MotionCount& count);

/// Says on stderr what was mended or left out in reading, and what stands against judging.
void warnOfReading(const std::string& path, const MotionCount& count);

/// Calls `visit` with every sample of the recording, rates and load filled in, and returns what was found.
/// Where the recording gives no load, it is what the joint is configured to carry.
/// @throws InputError as readMotion.
MotionFindings visitMotion(const MotionSource& source, const MotionDriven& twin,
                           const std::function<void(const MotionSample&)>& visit);
MotionFindings visitMotion(const MotionOptions& options, const MotionDriven& twin,
                           const std::function<void(const MotionSample&)>& visit);
}  // namespace hjt
