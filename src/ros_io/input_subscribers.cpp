// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/input_subscribers.hpp"

#include <ros/console.h>
#include <ros/transport_hints.h>
#include <boost/function.hpp>

#include "ros_io/time.hpp"
#include "ros_io/topics.hpp"

namespace hjt
{
namespace
{
/// Seconds of messages at 1 kHz: a fast bag brings chunks, and none may be lost.
constexpr std::uint32_t QUEUE_SIZE = Inbox::CAPACITY;
/// Between two warnings of the same kind [s].
constexpr double WARNING_PERIOD = 5.0;

template <class Message>
ros::Subscriber subscribe(ros::NodeHandle& node, const char* topic, boost::function<void(const Message&)> receive)
{
  // Small messages at a high rate: without the delay that the transport would gather them with.
  return node.subscribe<Message>(
      topic, QUEUE_SIZE, [receive](const boost::shared_ptr<const Message>& message) { receive(*message); },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}
}  // namespace

InputSubscribers::InputSubscribers(ros::NodeHandle& node, const Parameters& parameters, Inbox& inbox)
  : parameters_(parameters), names_(parameters.joint.name), inbox_(inbox)
{
  using sensor_msgs::JointState;
  using std_msgs::Float64;
  motor_torque_subscriber_ =
      subscribe<Float64>(node, topics::MOTOR_TORQUE_COMMAND,
                         [this](const Float64& message) { receiveNow(InputKind::MOTOR_TORQUE, message); });
  load_torque_subscriber_ = subscribe<Float64>(
      node, topics::LOAD_TORQUE, [this](const Float64& message) { receiveNow(InputKind::LOAD_TORQUE, message); });
  command_subscriber_ =
      subscribe<JointState>(node, topics::COMMAND, [this](const JointState& message) { receiveCommand(message); });
  load_subscriber_ =
      subscribe<JointState>(node, topics::LOAD, [this](const JointState& message) { receiveLoad(message); });
  fault_subscriber_ = subscribe<harmonic_joint_twin::Fault>(
      node, topics::INJECT_FAULT, [this](const harmonic_joint_twin::Fault& message) { receiveFault(message); });
}

void InputSubscribers::receiveNow(InputKind kind, const std_msgs::Float64& message)
{
  inbox_.push({ fromRosTime(ros::Time::now()), kind, message.data });
}

void InputSubscribers::receiveCommand(const sensor_msgs::JointState& message)
{
  double torque = 0.0;
  const EffortStatus status = readMotorTorque(message, names_, torque);
  if (status == EffortStatus::FOUND)
  {
    receiveStamped(InputKind::MOTOR_TORQUE, message.header.stamp, torque);
    return;
  }
  refuse(status, topics::COMMAND, names_.joint + " or " + names_.motor);
}

void InputSubscribers::receiveLoad(const sensor_msgs::JointState& message)
{
  double torque = 0.0;
  const EffortStatus status = readLoadTorque(message, names_, torque);
  if (status == EffortStatus::FOUND)
  {
    receiveStamped(InputKind::LOAD_TORQUE, message.header.stamp, torque);
    return;
  }
  refuse(status, topics::LOAD, names_.joint);
}

void InputSubscribers::receiveFault(const harmonic_joint_twin::Fault& message)
{
  Fault fault;
  const std::string errors = readFault(message, parameters_, fault);
  if (!errors.empty())
  {
    ++refused_fault_;
    ROS_WARN_STREAM("Refused a message on ~" << topics::INJECT_FAULT << ": " << errors);
    return;
  }
  const ros::Time& stamp = message.header.stamp;
  inbox_.push({ fromRosTime(stamp.isZero() ? ros::Time::now() : stamp), InputKind::FAULT, 0.0, fault });
}

void InputSubscribers::receiveStamped(InputKind kind, const ros::Time& stamp, double torque)
{
  inbox_.push({ fromRosTime(stamp.isZero() ? ros::Time::now() : stamp), kind, torque });
}

void InputSubscribers::refuse(EffortStatus status, const char* topic, const std::string& expected)
{
  if (status == EffortStatus::UNKNOWN_JOINT)
  {
    ++unknown_joint_;
    ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD, "Refused a message on ~" << topic << ": it does not name " << expected);
  }
  else
  {
    ++missing_effort_;
    ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD, "Refused a message on ~" << topic << ": no effort for " << expected);
  }
}
}  // namespace hjt
