// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/motion_options.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <optional>

#include "apps/common/interrupt.hpp"
#include "apps/common/progress.hpp"
#include "apps/common/validators.hpp"

#include "ros_io/topics.hpp"

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

MotionSource motionSource(const MotionOptions& options)
{
  MotionSource source;
  source.path = options.recording;
  source.topic = options.topic;
  source.load_topic = options.joint_namespace + "/" + topics::LOAD;
  source.joint = options.joint;
  const auto* known =
      std::find_if(UR_JOINTS.begin(), UR_JOINTS.end(),
                   [&](const auto& names) { return names[0] == options.joint || names[1] == options.joint; });
  if (known != UR_JOINTS.end())
  {
    source.joint = (*known)[1];
    source.csv_joint = static_cast<int>(known - UR_JOINTS.begin());
  }
  return source;
}

void addMotionOptions(CLI::App& command, MotionOptions& options)
{
  options.joint_namespace = DEFAULT_NAMESPACE;
  options.topic = "/joint_states";
  command.add_option("recording", options.recording, "a bag, or a UR controller's CSV recording")
      ->required()
      ->type_name("IN.bag|IN.csv")
      ->check(BAG_OR_CSV);
  command.add_option("--joint", options.joint, "base, shoulder, elbow, wrist_1 ..., or its name in the messages")
      ->required();
  command.add_option("--topic", options.topic, "of the telemetry, sensor_msgs/JointState, effort in A")
      ->capture_default_str();
  addNamespaceOption(command, options.joint_namespace);
  addCommonOptions(command, options);
}

MotionFindings visitMotion(const MotionSource& source, const MotionDriven& twin,
                           const std::function<void(const MotionSample&)>& visit)
{
  MotionFindings findings;
  findings.has_load = recordsLoad(source);
  MotionSmoother smoother;
  Progress progress("reading");
  const auto forward = [&](bool at_end)
  {
    while (std::optional<MotionSample> sample = smoother.pop(at_end))
    {
      if (!findings.has_load)
      {
        sample->load = twin.modelledLoad(*sample);
      }
      visit(*sample);
    }
  };
  static_cast<MotionCount&>(findings) = readMotion(
      source,
      [&](const MotionRow& row)
      {
        smoother.push(row);
        forward(false);
        return interruptSignal() == 0;
      },
      [&](double done) { progress.update(done); });
  forward(true);
  findings.refused = smoother.refused();
  findings.gaps = smoother.gaps();
  if (findings.corrupt > 0 || findings.refused > 0 || findings.gaps > 0)
  {
    std::cerr << "joint_twin: " << source.path << ": " << findings.corrupt << " messages unreadable or impossible, "
              << findings.refused << " rows repeated or out of order, " << findings.gaps << " gaps over "
              << MotionSmoother::LONGEST_GAP << " s\n";
  }
  return findings;
}

MotionFindings visitMotion(const MotionOptions& options, const MotionDriven& twin,
                           const std::function<void(const MotionSample&)>& visit)
{
  return visitMotion(motionSource(options), twin, visit);
}
}  // namespace hjt
