// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Temperature.h>

#include "arm/arm_load.hpp"
#include "arm/arm_watch.hpp"
#include "arm/recording_fit.hpp"
#include "ros_io/joint_tracker.hpp"
#include "tracking/telemetry_rows.hpp"

namespace hjt
{
/// Twins beside a robot, live: of one joint, or of all joints of an arm, whose load then follows from the motion of
/// all. Each message is read once.
class TrackerNode
{
public:
  /// Of one joint. @param parameters with input.mode other than commands. @throws ParameterError.
  TrackerNode(ros::NodeHandle& node, const Parameters& parameters);

  /// The arm beside the node.
  struct Arm
  {
    ArmDescription description;
    std::vector<Parameters> joints;
    std::vector<SoundJoint> sound;        ///< figures of each joint when it was sound
    bool is_identified{};                 ///< the joints' friction is that of this very arm
    std::string name;                     ///< of a shipped one that may be another
    ArmWatch::MakeCandidates candidates;  ///< none: it is taken at its word
    bool unit_is_given{};                 ///< of the efforts: it is no open question
  };

  /// @throws ParameterError.
  TrackerNode(ros::NodeHandle& node, const Arm& arm);

private:
  using JointStateEvent = ros::MessageEvent<const sensor_msgs::JointState>;

  void addJoint(ros::NodeHandle node, const Parameters& parameters, const SoundJoint& sound, bool is_identified);
  void subscribe(ros::NodeHandle& node);
  void receiveTelemetry(const JointStateEvent& event);
  void receiveLoad(const JointStateEvent& event);
  void receiveTemperature(const ros::MessageEvent<const sensor_msgs::Temperature>& event);
  std::string lackOf(const sensor_msgs::JointState& message) const;
  bool isWithoutEffort() const;
  void push(Stamp stamp);
  void take(const ArmSample& sample);
  void follow(const std::vector<MotionRow>& rows);
  void watchArm(const std::vector<MotionRow>& rows);
  void lookAtArm();
  void tryOnArm(const std::function<void()>& act);
  void resetFit();
  void restart();
  void lookAtLoad();
  JudgedJoints judgedJoints() const;
  std::string sinceText(double since) const;
  void updateFit(const ArmSample& sample);
  void lookAtFit();
  void judge(const ros::WallTime& now);
  void look();
  void missTelemetry();

  std::mutex mutex_;  // of everything below: callbacks run in several threads
  TelemetryStream stream_;
  std::vector<std::unique_ptr<JointTracker>> joints_;
  std::optional<RowFilter> filter_;  // of all joints together
  std::optional<ArmLoad> arm_load_;
  std::optional<RecordingFit> fit_;  // of an arm
  std::optional<LoadWatch> load_;
  std::optional<ArmWatch> arm_;  // which it is
  std::vector<MotionRow> efforts_;
  const double repeat_tolerance_;  // comparison.repeat_tolerance [-]
  ros::WallTime next_verdict_;
  double next_fit_{};            // when its findings are looked at [s]
  std::vector<MotionRow> rows_;  // of the joints, in the message at hand
  std::vector<UnfoldedAngle> angles_;
  bool has_efforts_{};  // a row had
  double last_time_{};  // [s]
  ros::WallTimer timer_;
  ros::WallTimer patience_;  // until the first message is missed
  ros::Subscriber telemetry_subscriber_;
  ros::Subscriber load_subscriber_;
  ros::Subscriber temperature_subscriber_;
};
}  // namespace hjt
