// SPDX-License-Identifier: BSD-3-Clause
#include "bags/bag_inputs.hpp"

#include <algorithm>
#include <cmath>

#include <rosbag/view.h>
#include <std_msgs/Float64.h>

#include "bags/message_decoder.hpp"
#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/channels.hpp"

namespace hjt
{
namespace
{
/// Largest difference between a stamp and the time of recording [s]. A larger one shows that two clocks disagree.
constexpr double MAX_DELAY = 10.0;

/// Converts the messages of a bag to inputs.
class InputReader
{
public:
  InputReader(const std::string& joint_namespace, const std::string& joint)
    : prefix_(joint_namespace + "/"), names_(joint)
  {
  }

  /// Converts one message. @throws InputError.
  void read(const rosbag::MessageInstance& message, const Parameters& parameters)
  {
    try
    {
      readInput(message, parameters);
    }
    catch (const ros::Exception&)
    {
      ++result_.damaged;
    }
  }

  BagInputs take()
  {
    std::stable_sort(result_.inputs.begin(), result_.inputs.end(),
                     [](const TwinInput& a, const TwinInput& b) { return hjt::stampOf(a) < hjt::stampOf(b); });
    return std::move(result_);
  }

private:
  void readInput(const rosbag::MessageInstance& message, const Parameters& parameters)
  {
    const std::string& topic = message.getTopic();
    if (topic == prefix_ + topics::COMMAND)
    {
      readStamped(message, InputKind::MOTOR_TORQUE, readMotorTorque);
    }
    else if (topic == prefix_ + topics::LOAD)
    {
      readStamped(message, InputKind::LOAD_TORQUE, readLoadTorque);
    }
    else if (topic == prefix_ + topics::INJECT_FAULT)
    {
      readFaultMessage(message, parameters);
    }
    else
    {
      const bool command = topic == prefix_ + topics::MOTOR_TORQUE_COMMAND;
      const auto value = instantiate<std_msgs::Float64>(message);
      result_.inputs.push_back(Input{ fromRosTime(message.getTime()),
                                      command ? InputKind::MOTOR_TORQUE : InputKind::LOAD_TORQUE, value->data });
    }
  }

  template <class Message>
  static boost::shared_ptr<Message> instantiate(const rosbag::MessageInstance& message)
  {
    auto instance = message.instantiate<Message>();
    if (!instance)
    {
      throw InputError(message.getTopic() + " has type " + message.getDataType() + ", expected " +
                       ros::message_traits::datatype<Message>());
    }
    return instance;
  }

  static Stamp stampOf(const rosbag::MessageInstance& instance, const std_msgs::Header& header)
  {
    const Stamp recorded = fromRosTime(instance.getTime());
    const Stamp stamp = header.stamp.isZero() ? recorded : fromRosTime(header.stamp);
    const double delay = toSeconds(recorded - stamp);
    if (std::abs(delay) > MAX_DELAY)
    {
      throw InputError(instance.getTopic() + ": a message is stamped " + numberText(std::abs(delay)) + " s " +
                       (delay > 0.0 ? "before" : "after") + " the time it was recorded at; the clocks do not agree");
    }
    return stamp;
  }

  void readFaultMessage(const rosbag::MessageInstance& instance, const Parameters& parameters)
  {
    const auto message = instantiate<harmonic_joint_twin::Fault>(instance);
    const Stamp stamp = stampOf(instance, message->header);
    std::vector<Fault> steps;
    if (!readFault(*message, parameters, steps).empty())
    {
      ++result_.refused_faults;
      return;
    }
    for (const Fault& fault : steps)
    {
      result_.inputs.push_back(StampedFault{ stamp, fault });
    }
  }

  template <class ReadTorque>
  void readStamped(const rosbag::MessageInstance& instance, InputKind kind, ReadTorque read_torque)
  {
    if (!checked_.read(instance))
    {
      ++result_.damaged;
      return;
    }
    const sensor_msgs::JointState& message = checked_.state();
    const Stamp stamp = stampOf(instance, message.header);
    double torque{};
    switch (read_torque(message, names_, torque))
    {
      case EffortStatus::FOUND:
        result_.inputs.push_back(Input{ stamp, kind, torque });
        break;
      case EffortStatus::MISSING_EFFORT:
        ++result_.without_effort;
        break;
      case EffortStatus::UNKNOWN_JOINT:
        result_.other_joints.insert(message.name.begin(), message.name.end());
        break;
    }
  }

  std::string prefix_;
  JointNames names_;
  CheckedMessage checked_;
  BagInputs result_;
};
}  // namespace

std::vector<std::string> inputTopics(const std::string& joint_namespace)
{
  const std::string prefix = joint_namespace + "/";
  return { prefix + topics::COMMAND, prefix + topics::MOTOR_TORQUE_COMMAND, prefix + topics::LOAD,
           prefix + topics::LOAD_TORQUE, prefix + topics::INJECT_FAULT };
}

std::vector<std::string> outputTopics(const std::string& joint_namespace)
{
  std::vector<std::string> names{ joint_namespace + "/" + topics::FAULTS };
  std::apply([&](const auto&... channel) { (names.push_back(joint_namespace + "/" + channel.name), ...); }, CHANNELS);
  return names;
}

BagInputs readBagInputs(const rosbag::Bag& bag, const std::string& joint_namespace, const Parameters& parameters)
{
  InputReader reader(joint_namespace, parameters.joint.name);
  rosbag::View view(bag, rosbag::TopicQuery(inputTopics(joint_namespace)));
  for (const rosbag::MessageInstance& message : view)
  {
    reader.read(message, parameters);
  }
  return reader.take();
}
}  // namespace hjt
