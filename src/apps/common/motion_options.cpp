// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/motion_options.hpp"

#include <iostream>
#include <memory>

#include "output/interrupt.hpp"
#include "output/progress.hpp"

namespace hjt
{
Watch readingWatch()
{
  return { showProgress, Watch().stopped,
           [](const std::string& text) { std::cerr << "joint_twin: " << text << '\n'; } };
}

Watch consoleWatch()
{
  Watch watch = readingWatch();
  watch.stopped = [interrupts = std::make_shared<InterruptScope>()] { return interruptSignal() != 0; };
  return watch;
}

void addRecording(Command& command, RecordingOptions& options)
{
  command
      .add("recording", options.recording,
           "a bag, a .db3 or .mcap file of ROS 2 or their directory, or a UR controller's CSV recording")
      .required()
      .type("IN.bag|IN.db3|IN.mcap|DIR|IN.csv");
}

void addReadingOptions(Command& command, RecordingOptions& options, bool& json)
{
  command.add("--topic", options.topic,
              "of a bag's telemetry, sensor_msgs/JointState, effort as telemetry.effort says");
  command.add("--prefix", options.affixes.prefix,
              "before the arm's names of the joints in the messages, as left_; `joint_twin check` finds it");
  command.add("--suffix", options.affixes.suffix, "behind them");
  command
      .add("--time-scale", options.time_scale,
           "multiplies the times of the rows where the stamps are wrong; `joint_twin check` finds it")
      .positive();
  addNamespaceOption(command, options.joint_namespace);
  addCommonOptions(command, options, json, options.force);
}

void addArmOption(Command& command, RecordingOptions& options)
{
  command
      .add("--arm", options.arm,
           "all joints of an arm in place of one: ur3, ur3e, ur5, ur5e (ur7e), ur8long, ur10, ur10e (ur12e), ur15, "
           "ur16e, ur18, or a file as config/arms/ur5.yaml")
      .type("NAME|FILE.yaml");
}

void addJointOptions(Command& command, RecordingOptions& options, bool& json)
{
  command.add("--joint", options.joint,
              "base, shoulder, elbow, wrist_1 ..., its number from 0, or its name in the messages");
  addReadingOptions(command, options, json);
  addArmOption(command, options);
  command
      .add("--load", options.load,
           "load of an arm's joints: of its links and payload by rigid-body dynamics, or as recorded")
      .choice({ LOAD_OF_ARM, LOAD_RECORDED })
      .needs("--arm");
  command
      .add("--identified", options.identified,
           "overlays of an arm's joints, as `joint_twin identify --arm` writes them, over the arm's own")
      .type("DIR")
      .existingDirectory()
      .needs("--arm");
  command.oneOf({ "--joint", "--arm" });
}

void addArmOptions(Command& command, RecordingOptions& options, bool& json)
{
  addRecording(command, options);
  addJointOptions(command, options, json);
}
}  // namespace hjt
