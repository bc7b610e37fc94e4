// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recording_options.hpp"

#include <array>

namespace hjt
{
namespace
{
/// Short name and that in the messages of UR's driver, in the order of the columns of its recordings.
constexpr std::array<std::array<const char*, 2>, 6> UR_JOINTS{ { { "base", "shoulder_pan_joint" },
                                                                 { "shoulder", "shoulder_lift_joint" },
                                                                 { "elbow", "elbow_joint" },
                                                                 { "wrist_1", "wrist_1_joint" },
                                                                 { "wrist_2", "wrist_2_joint" },
                                                                 { "wrist_3", "wrist_3_joint" } } };
}  // namespace

std::optional<UrJoint> findUrJoint(const std::string& name)
{
  for (std::size_t i = 0; i < UR_JOINTS.size(); ++i)
  {
    if (name == UR_JOINTS[i][0] || name == UR_JOINTS[i][1] || name == std::to_string(i))
    {
      return UrJoint{ static_cast<int>(i), UR_JOINTS[i][1] };
    }
  }
  return std::nullopt;
}

MotionSource motionSource(const RecordingOptions& options)
{
  MotionSource source;
  source.path = options.recording;
  source.format = options.rows ? RecordingFormat::TABLE : formatOfRecording(source.path);
  source.topic = options.topic;
  source.load_topic = options.joint_namespace + "/" + topics::LOAD;
  source.joint = options.joint;
  source.time_scale = options.time_scale;
  source.rows = options.rows;
  if (const std::optional<UrJoint> known = findUrJoint(options.joint))
  {
    source.joint = options.affixes(known->name);
    source.csv_joint = known->number;
  }
  else if (!options.joint.empty())
  {
    source.csv_joint = NO_COLUMNS;
  }
  return source;
}
}  // namespace hjt
