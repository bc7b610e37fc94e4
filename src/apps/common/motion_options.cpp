// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/motion_options.hpp"

#include <array>
#include <cmath>
#include <iostream>
#include <optional>

#include "output/interrupt.hpp"
#include "output/progress.hpp"
#include "output/text_table.hpp"

#include "base/number_text.hpp"
#include "messages/topics.hpp"
#include "tracking/ratio_fit.hpp"

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

MotionSource motionSource(const MotionOptions& options)
{
  MotionSource source;
  source.path = options.recording;
  source.topic = options.topic;
  source.load_topic = options.joint_namespace + "/" + topics::LOAD;
  source.joint = options.joint;
  source.time_scale = options.time_scale;
  if (const std::optional<UrJoint> known = findUrJoint(options.joint))
  {
    source.joint = options.affixes(known->name);
    source.csv_joint = known->number;
  }
  return source;
}

void addRecording(Command& command, MotionOptions& options)
{
  command
      .add("recording", options.recording,
           "a bag, a .db3 or .mcap file of ROS 2 or their directory, or a UR controller's CSV recording")
      .required()
      .type("IN.bag|IN.db3|IN.mcap|DIR|IN.csv");
}

void addReadingOptions(Command& command, MotionOptions& options)
{
  options.joint_namespace = DEFAULT_NAMESPACE;
  options.topic = DEFAULT_TOPIC;
  command.add("--topic", options.topic, "of the telemetry, sensor_msgs/JointState, effort as telemetry.effort says");
  command.add("--prefix", options.affixes.prefix,
              "before the arm's names of the joints in the messages, as left_; `joint_twin check` finds it");
  command.add("--suffix", options.affixes.suffix, "behind them");
  command
      .add("--time-scale", options.time_scale,
           "multiplies the times of the rows where the stamps are wrong; `joint_twin check` finds it")
      .positive();
  addNamespaceOption(command, options.joint_namespace);
  addCommonOptions(command, options);
}

namespace
{
CommandOption addAll(Command& command, MotionOptions& options)
{
  addRecording(command, options);
  const CommandOption joint = command.add(
      "--joint", options.joint, "base, shoulder, elbow, wrist_1 ..., its number from 0, or its name in the messages");
  addReadingOptions(command, options);
  return joint;
}
}  // namespace

void addRecordingOptions(Command& command, MotionOptions& options)
{
  addAll(command, options);
}

void addMotionOptions(Command& command, MotionOptions& options)
{
  addAll(command, options).required();
}

void warnOfStamps(const MotionCount& count)
{
  constexpr double TOLERANCE = 0.03;
  if (std::isfinite(count.velocity_ratio) && std::abs(count.velocity_ratio - 1.0) > TOLERANCE)
  {
    const std::string factor = roundedText(count.velocity_ratio, 3);
    std::cerr << "joint_twin: by their stamps the angles change " << factor
              << " times as fast as the recorded velocities say: one of the two is wrong, and with the stamps all "
                 "results"
              << (count.velocity_ratio > 0.0 ? "; --time-scale " + factor + " makes them agree\n" : "\n");
  }
}

void warnOfReading(const std::string& path, const MotionCount& count)
{
  for (const std::string& remark : count.remarks)
  {
    std::cerr << "joint_twin: " << path << ": " << remark << '\n';
  }
  if (!count.misfit.empty())
  {
    std::cerr << "joint_twin: " << path << ": " << count.misfit << '\n';
  }
}

MotionFindings visitMotion(const MotionSource& recording, const MotionDriven& twin,
                           const std::function<void(const MotionSample&)>& visit)
{
  MotionSource source = recording;
  source.current_per_effort = twin.currentPerEffort();
  MotionFindings findings;
  findings.has_load = recordsLoad(source);
  MotionDifferentiator smoother;
  RatioFit ratio(twin.ratio());
  const InterruptScope interrupts;
  Progress progress("reading");
  const auto forward = [&](bool at_end)
  {
    while (std::optional<MotionSample> sample = smoother.pop(at_end))
    {
      if (!findings.has_load)
      {
        sample->load = twin.modelledLoad(*sample);
      }
      ratio.add(*sample);
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
  findings.misfit = findings.misfit.empty() ? ratio.text() : findings.misfit;
  warnOfStamps(findings);
  warnOfReading(source.path, findings);
  if (findings.corrupt > 0 || findings.refused > 0 || findings.gaps > 0)
  {
    std::cerr << "joint_twin: " << source.path << ": " << findings.corrupt << " messages unreadable or impossible, "
              << findings.refused << " rows repeated or out of order, " << findings.gaps << " gaps over "
              << MotionDifferentiator::MAX_GAP << " s\n";
  }
  return findings;
}

MotionFindings visitMotion(const MotionOptions& options, const MotionDriven& twin,
                           const std::function<void(const MotionSample&)>& visit)
{
  return visitMotion(motionSource(options), twin, visit);
}
}  // namespace hjt
