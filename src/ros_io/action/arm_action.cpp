// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/arm_node.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>

#include <actionlib/server/action_server.h>
#include <control_msgs/FollowJointTrajectoryAction.h>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"
#include "ros_io/arm_trajectory.hpp"
#include "ros_io/parameter_server.hpp"

namespace hjt
{
namespace
{
using Action = control_msgs::FollowJointTrajectoryAction;
using Goal = control_msgs::FollowJointTrajectoryGoal;
using Result = control_msgs::FollowJointTrajectoryResult;
using Point = trajectory_msgs::JointTrajectoryPoint;

constexpr const char* DRIVERS_CONTROLLER = "scaled_pos_joint_traj_controller";
constexpr const char* FOLLOW = "follow_joint_trajectory";
// Default tolerances of a goal, as in config/ur5_controllers.yaml of ur_robot_driver.
constexpr double PATH_POSITION = 0.2;  // tolerance of an angle during the motion [rad]
constexpr double END_POSITION = 0.1;   // tolerance of an angle at the end [rad]
constexpr double END_SPEED = 0.05;     // tolerance of a speed at the end [rad/s]
constexpr double PATIENCE = 0.6;       // time after the end of the motion within which the arm must arrive [s]

constexpr double LOOK_PERIOD = 0.01;  // time between two checks of the report [s]
constexpr int LOOKS_A_FEEDBACK = 5;

/// Sets a tolerance by the rule of JointTolerance.msg: 0 keeps the default, a negative value permits any deviation.
void take(double given, double& tolerance)
{
  tolerance = given < 0.0 ? HUGE_VAL : given > 0.0 ? given : tolerance;
}

/// Reads tolerances of joints, except of accelerations. @returns the error; empty if the tolerances are valid.
std::string takeTolerances(const std::vector<control_msgs::JointTolerance>& given, const char* what,
                           const ArmDescription& arm, std::vector<JointTolerance>& tolerances)
{
  for (const control_msgs::JointTolerance& each : given)
  {
    const auto joint = std::find_if(arm.joints.begin(), arm.joints.end(),
                                    [&](const ArmJoint& other) { return other.name == each.name; });
    if (joint == arm.joints.end())
    {
      return std::string(what) + " names '" + printable(each.name) + "', which is not a joint of the arm";
    }
    if (std::isnan(each.position) || std::isnan(each.velocity))
    {
      return std::string(what) + " of " + each.name + " is not a number";
    }
    JointTolerance& tolerance = tolerances[static_cast<std::size_t>(joint - arm.joints.begin())];
    take(each.position, tolerance.position);
    take(each.velocity, tolerance.velocity);
  }
  return {};
}

Point makePoint(const std::vector<JointMotion>& joints)
{
  Point point;
  for (const JointMotion& joint : joints)
  {
    point.positions.push_back(joint.position);
    point.velocities.push_back(joint.velocity);
  }
  return point;
}

Result makeResult(int code, const std::string& text)
{
  Result result;
  result.error_code = code;
  result.error_string = text;
  return result;
}

/// Action server with one goal at a time; a new goal replaces the active one.
class ArmAction
{
public:
  ArmAction(ros::NodeHandle& node, ArmNode& arm)
    : arm_(arm)
    , server_(
          parent_, node.param<std::string>(CONTROLLER, DRIVERS_CONTROLLER) + "/" + FOLLOW,
          [this](GoalHandle goal) { receive(goal); }, [this](GoalHandle goal) { cancel(goal); }, false)
    , timer_(parent_.createWallTimer(
          ros::WallDuration(LOOK_PERIOD), [this](const auto&) { look(); }, false, false))
  {
    server_.start();
  }

private:
  using Server = actionlib::ActionServer<Action>;
  using GoalHandle = Server::GoalHandle;

  void receive(GoalHandle& handle)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const Goal& asked = *handle.getGoal();
    const ArmDescription& arm = arm_.description();
    const std::string strangers = asked.trajectory.points.empty() ? "" : jointErrors(asked.trajectory, arm);
    ArmGoal goal;
    goal.path.assign(arm.joints.size(), { PATH_POSITION, HUGE_VAL });
    goal.end.assign(arm.joints.size(), { END_POSITION, END_SPEED });
    goal.patience = asked.goal_time_tolerance.isZero() ? PATIENCE : std::max(asked.goal_time_tolerance.toSec(), 0.0);
    std::string errors = strangers;
    errors = errors.empty() ? takeTolerances(asked.path_tolerance, "path_tolerance", arm, goal.path) : errors;
    errors = errors.empty() ? takeTolerances(asked.goal_tolerance, "goal_tolerance", arm, goal.end) : errors;
    errors = errors.empty() ? arm_.command(asked.trajectory, goal) : errors;
    if (!errors.empty())
    {
      ROS_WARN_STREAM("Refused a goal of " << FOLLOW << ": " << errors);
      handle.setRejected(makeResult(strangers.empty() ? Result::INVALID_GOAL : Result::INVALID_JOINTS, errors), errors);
      return;
    }
    if (current_)
    {
      setCancelled("another goal has replaced this goal");
    }
    handle.setAccepted();
    current_ = handle;
    number_ = goal.number;
    timer_.start();
  }

  void cancel(GoalHandle& handle)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (current_ && *current_ == handle)
    {
      rest();
      setCancelled("the client has cancelled the goal");
    }
  }

  void look()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const GoalReport report = arm_.report();
    if (!current_ || report.number < number_)
    {
      return;  // the loop has not yet taken the command of this goal
    }
    if (report.number > number_)
    {
      setCancelled(std::string("a trajectory on ~") + topics::COMMAND + " has replaced the goal");
      return;
    }
    if (++looks_ % LOOKS_A_FEEDBACK == 0)
    {
      publish(report);
    }
    if (report.state != GoalState::UNDER_WAY)
    {
      end(report);
    }
  }

  void end(const GoalReport& report)
  {
    const std::string missed = arm_.description().joints[report.joint].name + " is off by " +
                               roundedText(report.error, 3) + (report.is_speed ? " rad/s" : " rad") + ", tolerance " +
                               roundedText(report.tolerance, 3);
    if (report.state == GoalState::REACHED)
    {
      current_->setSucceeded(makeResult(Result::SUCCESSFUL, ""));
    }
    else if (report.state == GoalState::FORGOTTEN)
    {
      setCancelled("the arm was reset");
    }
    else if (report.state == GoalState::STOPPED)
    {
      abort(Result::PATH_TOLERANCE_VIOLATED, "protective stop: " + arm_.stopReason());
    }
    else if (report.state == GoalState::OFF_PATH)
    {
      rest();
      abort(Result::PATH_TOLERANCE_VIOLATED, missed);
    }
    else
    {
      abort(Result::GOAL_TOLERANCE_VIOLATED, missed);
    }
    forget();
  }

  void rest()
  {
    ArmGoal unwatched;
    arm_.command({}, unwatched);
  }

  void abort(int code, const std::string& text) { current_->setAborted(makeResult(code, text), text); }

  void setCancelled(const std::string& text)
  {
    current_->setCanceled(makeResult(Result::SUCCESSFUL, text), text);
    forget();
  }

  void forget()
  {
    current_.reset();
    timer_.stop();
  }

  void publish(const GoalReport& report)
  {
    control_msgs::FollowJointTrajectoryFeedback feedback;
    feedback.header.stamp = toRosTime(report.stamp);
    std::vector<JointMotion> errors;
    for (std::size_t i = 0; i < report.wanted.size(); ++i)
    {
      const JointMotion& wanted = report.wanted[i];
      const JointMotion& actual = report.actual[i];
      feedback.joint_names.push_back(arm_.description().joints[i].name);
      errors.push_back({ wanted.position - actual.position, wanted.velocity - actual.velocity, 0.0 });
    }
    feedback.desired = makePoint(report.wanted);
    feedback.actual = makePoint(report.actual);
    feedback.error = makePoint(errors);
    current_->publishFeedback(feedback);
  }

  ArmNode& arm_;
  std::mutex mutex_;
  std::optional<GoalHandle> current_;
  std::uint64_t number_{};  // number of the goal's command
  int looks_{};
  ros::NodeHandle parent_;
  Server server_;
  ros::WallTimer timer_;
};
}  // namespace

std::shared_ptr<void> offerArmAction(ros::NodeHandle& node, ArmNode& arm)
{
  return std::make_shared<ArmAction>(node, arm);
}
}  // namespace hjt
