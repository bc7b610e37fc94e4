// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recording_options.hpp"

#include <array>
#include <regex>

namespace hjt
{
namespace
{
/// Short names of UR's joints and their names in the messages of UR's driver, in the order of the columns of a table.
constexpr std::array<std::array<const char*, 2>, 6> UR_JOINTS{ { { "base", "shoulder_pan_joint" },
                                                                 { "shoulder", "shoulder_lift_joint" },
                                                                 { "elbow", "elbow_joint" },
                                                                 { "wrist_1", "wrist_1_joint" },
                                                                 { "wrist_2", "wrist_2_joint" },
                                                                 { "wrist_3", "wrist_3_joint" } } };

void addReadingOptions(OptionTable& table, RecordingOptions& options)
{
  table.add("--topic", options.topic,
            "topic of the telemetry in a bag, sensor_msgs/JointState with the effort that telemetry.effort names");
  table.add("--prefix", options.affixes.prefix,
            "prefix of the arm's joint names in the messages, for example left_; `joint_twin check` finds it");
  table.add("--suffix", options.affixes.suffix, "suffix of the arm's joint names in the messages");
  table
      .add("--time-scale", options.time_scale,
           "factor that corrects the times of the rows if the stamps are wrong; `joint_twin check` finds it")
      .positive();
  addNamespaceOption(table, options.joint_namespace);
  addOptions(table, options, options.force);
}

void addArmOption(OptionTable& table, RecordingOptions& options)
{
  table
      .add("--arm", options.arm,
           "arm, all of whose joints are read: ur3, ur3e, ur5, ur5e (ur7e), ur8long, ur10, ur10e (ur12e), ur15, "
           "ur16e, ur18, or a file such as config/arms/ur5.yaml")
      .type("NAME|FILE.yaml");
}
}  // namespace

void addRecordingOption(OptionTable& table, RecordingOptions& options)
{
  table
      .add("recording", options.recording,
           "a bag, a .db3 or .mcap file of ROS 2, a directory of such files, or a UR controller's CSV recording")
      .required()
      .type("IN.bag|IN.db3|IN.mcap|DIR|IN.csv");
}

void addOptions(OptionTable& table, RecordingOptions& options)
{
  addRecordingOption(table, options);
  addArmOption(table, options);
  addReadingOptions(table, options);
}

void addJointOptions(OptionTable& table, RecordingOptions& options)
{
  table.add("--joint", options.joint,
            "base, shoulder, elbow, wrist_1 ..., the joint's number from 0, or its name in the messages");
  addReadingOptions(table, options);
  addArmOption(table, options);
  table
      .add("--load", options.load,
           "load of an arm's joints: computed from links and payload by rigid-body dynamics, or as recorded")
      .choice({ LOAD_OF_ARM, LOAD_RECORDED })
      .needs("--arm");
  table
      .add("--identified", options.identified,
           "overlays from `joint_twin identify --arm`, whose values replace those of the arm's joints")
      .type("DIR")
      .existingDirectory()
      .needs("--arm");
  table.oneOf({ "--joint", "--arm" });
}

void addNamespaceOption(OptionTable& table, std::string& joint_namespace)
{
  table.add("--joint-namespace", joint_namespace, "ROS namespace of the twin's topics")
      .type("NAME")
      .check(
          [](const std::string& name)
          {
            return std::regex_match(name, std::regex("(/[A-Za-z][A-Za-z0-9_]*)+")) ?
                       std::string() :
                       "'" + name + "' is not a global ROS name such as /joint_twin";
          });
}

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
