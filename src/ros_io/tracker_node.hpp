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
/// Live twins beside a robot: of one joint, or of all joints of an arm. With an arm, the motion of the arm gives the
/// loads. Each message is read once for all joints.
class TrackerNode
{
public:
  /// Node of one joint. @param parameters input.mode must not be commands. @throws ParameterError.
  TrackerNode(ros::NodeHandle& node, const Parameters& parameters);

  struct Arm
  {
    ArmDescription description;
    std::vector<Parameters> joints;
    std::vector<SoundJoint> sound;        ///< reference of each joint
    bool is_identified{};                 ///< whether the parameters contain friction that was identified on this arm
    std::string name;                     ///< name of the arm, for the check of the arm's type
    ArmWatch::MakeCandidates candidates;  ///< candidates for the check of the arm's type; null: no check
    bool unit_is_given{};                 ///< whether the user has given the unit of the efforts
  };

  /// Node of all joints of an arm. @throws ParameterError.
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

  std::mutex mutex_;  // protects the members below, because callbacks run in several threads
  TelemetryStream stream_;
  std::vector<std::unique_ptr<JointTracker>> joints_;
  std::optional<RowFilter> filter_;  // removes invalid rows of the joints
  std::optional<ArmLoad> arm_load_;
  std::optional<RecordingFit> fit_;  // check of the telemetry; only for an arm
  std::optional<LoadWatch> load_;
  std::optional<ArmWatch> arm_;  // check of the arm's type
  std::vector<MotionRow> efforts_;
  const double repeat_tolerance_;  // comparison.repeat_tolerance [-]
  ros::WallTime next_verdict_;
  double next_fit_{};            // time of the next check of the telemetry [s]
  std::vector<MotionRow> rows_;  // row of each joint in the present message
  std::vector<UnfoldedAngle> angles_;
  bool has_efforts_{};  // whether a row has had an effort
  double last_time_{};  // time of the last row [s]
  ros::WallTimer timer_;
  ros::WallTimer patience_;  // warns if the first message does not arrive
  ros::Subscriber telemetry_subscriber_;
  ros::Subscriber load_subscriber_;
  ros::Subscriber temperature_subscriber_;
};
}  // namespace hjt
