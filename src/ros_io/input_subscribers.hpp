// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <ros/console.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <ros/subscription_callback_helper.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>

#include "harmonic_joint_twin/Fault.h"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "live/thread_exchange.hpp"
#include "messages/conversions.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"

namespace hjt
{
/// Least time between two warnings of the same kind [s].
constexpr double WARNING_PERIOD = 5.0;

/// Subscribes to topics on which any node may publish. A message of more than MAX_BYTES is counted, not deserialised,
/// because the content would take a multiple of the message's length in memory.
struct InputTopics
{
  /// Twice the size of a JointState of 1000 joints [bytes].
  static constexpr std::size_t MAX_BYTES = 128 * 1024;
  /// Number of messages in 4 s at 1 kHz. A bag that is played fast sends bursts, which a twin behind the clock reads
  /// later. No message of a burst may be lost.
  static constexpr std::uint32_t QUEUE_SIZE = 4096;

  ros::NodeHandle& node;
  std::atomic<std::uint64_t>& too_large;

  template <class Message>
  ros::Subscriber subscribe(const char* topic,
                            const std::function<void(const ros::MessageEvent<const Message>&)>& receive) const
  {
    ros::SubscribeOptions options;
    options.topic = topic;
    options.queue_size = QUEUE_SIZE;
    options.md5sum = ros::message_traits::md5sum<Message>();
    options.datatype = ros::message_traits::datatype<Message>();
    options.helper = boost::make_shared<Reader<Message>>(receive, too_large);
    // TCP must send small messages at once instead of collecting them.
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    return node.subscribe(options);
  }

private:
  template <class Message>
  class Reader : public ros::SubscriptionCallbackHelperT<const ros::MessageEvent<const Message>&>
  {
  public:
    using Base = ros::SubscriptionCallbackHelperT<const ros::MessageEvent<const Message>&>;

    Reader(const std::function<void(const ros::MessageEvent<const Message>&)>& receive,
           std::atomic<std::uint64_t>& too_large)
      : Base(receive), too_large_(too_large)
    {
    }

    ros::VoidConstPtr deserialize(const ros::SubscriptionCallbackHelperDeserializeParams& message) override
    {
      if (message.length > MAX_BYTES)
      {
        ++too_large_;
        return {};
      }
      return Base::deserialize(message);
    }

  private:
    std::atomic<std::uint64_t>& too_large_;
  };
};

/// Puts faults of ~inject_fault into the inbox. An invalid fault is refused with a warning.
class FaultSubscriber
{
public:
  /// `twin`: the twin that gets the faults; `joint`: number of the twin's joint in the inbox.
  FaultSubscriber(const InputTopics& inputs, const Twin& twin, Inbox& inbox, std::size_t joint = 0)
    : twin_(twin)
    , inbox_(inbox)
    , joint_(joint)
    , subscriber_(inputs.subscribe<harmonic_joint_twin::Fault>(
          topics::INJECT_FAULT, [this](const auto& event) { receive(*event.getMessage()); }))
  {
  }

  std::uint64_t refused() const noexcept { return refused_; }  ///< number of refused faults since start

private:
  void receive(const harmonic_joint_twin::Fault& message)
  {
    // Least time between two warnings [s]. The time is short, because a warning says why a single fault was refused.
    constexpr double WARNING_PERIOD = 1.0;
    std::vector<Fault> steps;
    const std::string errors = readFault(message, twin_.parameters(), steps);
    if (!errors.empty())
    {
      ++refused_;
      ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD, "Refused a message on ~" << topics::INJECT_FAULT << ", " << refused_
                                                                        << " so far: " << errors);
      return;
    }
    const Stamp stamp = stampOr(message.header.stamp, ros::Time::now());
    for (const Fault& fault : steps)
    {
      inbox_.push(StampedFault{ stamp, fault }, joint_);
    }
  }

  const Twin& twin_;
  Inbox& inbox_;
  const std::size_t joint_;
  std::atomic<std::uint64_t> refused_{ 0 };
  ros::Subscriber subscriber_;
};

/// Numbers of refused messages since the start of the node.
struct MessageCounters
{
  std::uint64_t unknown_joint{};   ///< number of messages that name neither the joint nor, for a command, its motor
  std::uint64_t missing_effort{};  ///< number of messages that name the joint without an effort
  std::uint64_t refused_fault{};   ///< number of faults of unknown kind, or with a severity or place out of range
  std::uint64_t too_large{};       ///< number of messages of more than InputTopics::MAX_BYTES
};

/// Subscribes to the topics of torques and faults. Puts the content of a message into the inbox, with the stamp or, for
/// a message without a stamp, with the time of reception.
class InputSubscribers
{
public:
  InputSubscribers(ros::NodeHandle& node, const Twin& twin, Inbox& inbox)
    : names_(twin.parameters().joint.name), inbox_(inbox), faults_(InputTopics{ node, too_large_ }, twin, inbox)
  {
    using sensor_msgs::JointState;
    using std_msgs::Float64;
    const InputTopics inputs{ node, too_large_ };
    subscribers_ = {
      inputs.subscribe<Float64>(topics::MOTOR_TORQUE_COMMAND,
                                [this](const auto& event) { receiveNow(InputKind::MOTOR_TORQUE, event); }),
      inputs.subscribe<Float64>(topics::LOAD_TORQUE,
                                [this](const auto& event) { receiveNow(InputKind::LOAD_TORQUE, event); }),
      inputs.subscribe<JointState>(topics::COMMAND, [this](const auto& event) { receiveCommand(*event.getMessage()); }),
      inputs.subscribe<JointState>(topics::LOAD, [this](const auto& event) { receiveLoad(*event.getMessage()); }),
    };
  }

  MessageCounters counters() const noexcept
  {
    return { unknown_joint_, missing_effort_, faults_.refused(), too_large_ };
  }

private:
  void receiveNow(InputKind kind, const ros::MessageEvent<const std_msgs::Float64>& event)
  {
    inbox_.push(Input{ fromRosTime(event.getReceiptTime()), kind, event.getMessage()->data });
  }

  void receiveCommand(const sensor_msgs::JointState& message)
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

  void receiveLoad(const sensor_msgs::JointState& message)
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

  void receiveStamped(InputKind kind, const ros::Time& stamp, double torque)
  {
    inbox_.push(Input{ stampOr(stamp, ros::Time::now()), kind, torque });
  }

  void refuse(EffortStatus status, const char* topic, const std::string& expected)
  {
    if (status == EffortStatus::UNKNOWN_JOINT)
    {
      ++unknown_joint_;
      ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD, "Refused a message on ~" << topic << ": it does not name " << expected);
    }
    else
    {
      ++missing_effort_;
      ROS_WARN_STREAM_THROTTLE(WARNING_PERIOD,
                               "Refused a message on ~" << topic << ": it has no effort for " << expected);
    }
  }

  const JointNames names_;
  Inbox& inbox_;
  std::atomic<std::uint64_t> unknown_joint_{ 0 };
  std::atomic<std::uint64_t> missing_effort_{ 0 };
  std::atomic<std::uint64_t> too_large_{ 0 };
  FaultSubscriber faults_;
  std::array<ros::Subscriber, 4> subscribers_;
};
}  // namespace hjt
