// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <ros/init.h>
#include <ros/master.h>
#include <ros/names.h>
#include <ros/node_handle.h>
#include <ros/ros.h>
#include <ros/service_server.h>
#include <ros/this_node.h>
#include <ros/time.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "arm/arm_configuration.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "live/realtime.hpp"
#include "live/thread_exchange.hpp"
#include "live/twin_loop.hpp"
#include "messages/joint_affixes.hpp"
#include "messages/topics.hpp"
#include "params/configuration_files.hpp"
#include "ros_io/arm_node.hpp"
#include "ros_io/diagnostics.hpp"
#include "ros_io/input_subscribers.hpp"
#include "ros_io/life_publisher.hpp"
#include "ros_io/node_environment.hpp"
#include "ros_io/output_publishers.hpp"
#include "ros_io/parameter_server.hpp"
#include "ros_io/tracker_node.hpp"
#include "statics/gear_rules.hpp"

namespace hjt
{
namespace
{
/// Whether `publishers`, the publishers in the state of a ROS master, has this node for `topic`.
bool hasThisNode(XmlRpc::XmlRpcValue& publishers, const std::string& topic)
{
  for (int i = 0; i < publishers.size(); ++i)
  {
    XmlRpc::XmlRpcValue& nodes = publishers[i][1];
    for (int n = 0; static_cast<std::string&>(publishers[i][0]) == topic && n < nodes.size(); ++n)
    {
      if (static_cast<std::string&>(nodes[n]) == ros::this_node::getName())
      {
        return true;
      }
    }
  }
  return false;
}

/// Whether the present master knows all topics of this node. A master that came up during the node's start knows only
/// the last topics. If no master responds, the result is true, because connections continue without a master.
bool isKnownToMaster()
{
  XmlRpc::XmlRpcValue arguments;
  arguments[0] = ros::this_node::getName();
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  if (!ros::master::execute("getSystemState", arguments, response, state, false))
  {
    return true;
  }
  ros::V_string topics;
  ros::this_node::getAdvertisedTopics(topics);
  return std::all_of(topics.begin(), topics.end(),
                     [&](const std::string& topic) { return hasThisNode(state[0], topic); });
}

/// Waits until ROS shuts the node down. @returns false if a new ROS master has replaced the first one. A new master
/// does not know the node's topics; only a new start of the node sets parameters and registrations again.
bool waitForShutdownOrNewMaster()
{
  constexpr int LOOKS = 100;  // number of polls of ros::ok() between two questions to the master
  constexpr int MISSES =
      2;  // negative answers in succession that show a new master; a master that starts or ends may give only one
  const ros::WallDuration period(0.05);
  int misses = 0;
  for (int look = 1; ros::ok() && misses < MISSES; ++look)
  {
    period.sleep();
    if (look % LOOKS == 0)
    {
      misses = isKnownToMaster() ? 0 : misses + 1;
    }
  }
  return !ros::ok();
}

/// The live twin: connects a `Twin` to the topics and services of a node.
///
/// Threads of the node: a loop advances the twin, a publisher sends the messages, and a third thread ages the drive.
/// Callbacks, diagnostics and services run in at least two threads of a spinner, because a reset waits for the loop.
class TwinNode
{
public:
  /// Starts the twin. @throws ParameterError.
  TwinNode(ros::NodeHandle& node, const Parameters& parameters)
    : twin_(watchedTwin(parameters))
    , advanced_(twin_)
    , publishers_(node, twin_)
    , life_(node, parameters)
    , loop_(
          advanced_, parameters, inbox_, rosNow, rosClockKind(),
          [this]
          {
            publishers_.offer(twin_);
            const JointOutputs& joint = twin_.outputs();
            life_.offer(joint.stamp, joint.motor_velocity, joint.joint_torque, joint.temperature, twin_.assessment());
          },
          [this](Stamp instant) { return publishers_.finishCycle(instant); })
    , realtime_(requestRealtime(parameters.realtime, loop_))
    , subscribers_(node, twin_, inbox_)
    , timing_publisher_(node, parameters, loop_)
    , diagnostics_(node, parameters, loop_, realtime_, inbox_, subscribers_, publishers_)
    , reset_service_(node.advertiseService("reset", &TwinNode::reset, this))
    , brake_service_(node.advertiseService("brake", &TwinNode::setBrake, this))
  {
  }

private:
  static Twin watchedTwin(const Parameters& parameters)
  {
    // In simulated time the twin waits for its surface, so that every replay of a bag gives bit-identical results.
    Twin twin(parameters, nodeSurfaceSource(!ros::Time::isSimTime()));
    twin.watchSignals(true);
    return twin;
  }

  bool reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
  {
    response.success = loop_.reset();
    response.message =
        response.success ? "the twin restarts at the current instant" : "the loop of the twin does not respond";
    return true;
  }

  bool setBrake(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response)
  {
    inbox_.push(Input{ rosNow(), InputKind::BRAKE, request.data ? 1.0 : 0.0 });
    response.success = true;
    response.message = request.data ? "the brake engages" : "the brake releases";
    return true;
  }

  Twin twin_;
  AdvancedTwin advanced_;
  Inbox inbox_;
  OutputPublishers publishers_;
  LifePublisher life_;
  TwinLoop loop_;
  RealtimeState realtime_;
  InputSubscribers subscribers_;
  TimingPublisher timing_publisher_;
  Diagnostics diagnostics_;
  ros::ServiceServer reset_service_;
  ros::ServiceServer brake_service_;
};
}  // namespace
}  // namespace hjt

namespace
{
/// Time after the start at which the node warns if no message has arrived on /clock [s].
constexpr double CLOCK_PATIENCE = 10.0;

void warnOfParameters(const hjt::FoundParameters& found, const std::string& name,
                      const std::vector<hjt::ParameterMap>& shipped)
{
  const std::string departures = found.departures(name, shipped);
  if (!departures.empty())
  {
    ROS_WARN_STREAM("The parameter server has values from before this start that differ from the shipped ones: "
                    << departures << ". If they are from an earlier launch, use: rosparam delete " << name);
  }
}

template <class Node, class... Arguments>
void run(ros::NodeHandle& handle, const Arguments&... arguments)
{
  const Node node(handle, arguments...);
  ros::AsyncSpinner spinner(2);
  spinner.start();
  if (ros::Time::isSimTime() && !ros::Time::waitForValid(ros::WallDuration(CLOCK_PATIENCE)) && ros::ok())
  {
    ROS_WARN_STREAM(
        "/use_sim_time is true, but there is no time on /clock. For a real robot use rosparam delete /use_sim_time "
        "and start this node again");
  }
  if (!hjt::waitForShutdownOrNewMaster())
  {
    throw std::runtime_error(
        "The ROS master was replaced, and the new one does not know this node; start the node again");
  }
}

void runJoint(ros::NodeHandle& node, const hjt::FoundParameters& found)
{
  hjt::ParameterMap shipped;
  hjt::readDefaultConfiguration(hjt::configurationDirectory("").string(), shipped);
  warnOfParameters(found, node.getNamespace(), { shipped });
  hjt::ParameterMap map = hjt::readParameterServer(node.getNamespace());
  // A configuration from a launch file is complete. Without a launch file the node uses the shipped configuration.
  if (found.areGiven(map))
  {
    map.merge(shipped);
    hjt::writeParameterServer(node.getNamespace(), map);
  }
  const hjt::Parameters parameters = hjt::parseParameters(map);
  ROS_DEBUG_STREAM("Parameters:\n" << hjt::describeParameters(parameters));
  for (const std::string& warning : hjt::gearWarnings(parameters))
  {
    ROS_WARN_STREAM(warning);
  }
  if (parameters.input.mode == hjt::InputMode::COMMANDS)
  {
    run<hjt::TwinNode>(node, parameters);
  }
  else
  {
    run<hjt::TrackerNode>(node, parameters);
  }
}

/// Items of a list with commas between the items.
std::vector<std::string> itemsOf(const std::string& list)
{
  std::vector<std::string> items;
  std::istringstream text(list);
  for (std::string item; std::getline(text, item, ',');)
  {
    items.push_back(item);
  }
  return items;
}

/// Reference of each joint, from reports about the sound arm. @throws InputError if a joint is in none of the reports.
std::vector<hjt::SoundJoint> soundJointsOf(const std::string& list, const hjt::ArmDescription& arm,
                                           const std::vector<hjt::Parameters>& parameters)
{
  std::vector<hjt::SoundJoint> joints;
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    std::vector<std::string> directories;
    for (const std::string& item : itemsOf(list))
    {
      const std::filesystem::path report = item;
      const bool is_file = std::filesystem::is_regular_file(report);
      directories.push_back((is_file ? report.parent_path() : report) / arm.joints[i].short_name);
    }
    joints.push_back(hjt::readSoundJoint(directories, parameters[i]));
    if (joints.back().own.is_unjudged)
    {
      ROS_WARN_STREAM("The reference has no verdict on the friction of "
                      << arm.joints[i].short_name << ". The expected friction of this joint is that of the twin");
    }
  }
  return joints;
}

/// Parameters of every drive: `maps`, changed by the parameters of this node. Also writes them to the parameter server.
std::vector<hjt::Parameters> drivesOf(const hjt::ArmDescription& arm, const hjt::ParameterMap& overrides,
                                      std::vector<hjt::ParameterMap> maps)
{
  std::vector<hjt::Parameters> parameters;
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    const hjt::ArmJoint& joint = arm.joints[i];
    hjt::ParameterMap& map = maps[i];
    hjt::putOver(overrides, map);
    parameters.push_back(hjt::parseParameters(map));
    ros::param::del(hjt::jointName(joint));
    hjt::writeParameterServer(hjt::jointName(joint), map);
    hjt::Parameters& drive = parameters.back();
    if (drive.input.mode != parameters.front().input.mode)
    {
      throw hjt::ParameterError("input.mode must be equal for all joints of the arm, but differs for " +
                                joint.short_name);
    }
    if (drive.telemetry.load == hjt::LoadSource::ARM)
    {
      hjt::takeInertiaInLoad(drive);
    }
    ROS_INFO_STREAM(joint.short_name << " is " << drive.joint.name << ": flexspline with "
                                     << drive.gear.teeth_flexspline << " teeth, gain "
                                     << drive.telemetry.torque_per_current << " N.m/A, " << drive.input.temperature
                                     << " degC");
  }
  return parameters;
}

/// Candidates for the check of the arm's type: the shipped arms with joints like those of `arm`, each joint changed by
/// the node's parameters. Null if the arm `name` is not among them.
hjt::ArmWatch::MakeCandidates otherArms(const hjt::ArmDescription& arm, const std::string& name,
                                        const hjt::ParameterMap& overrides)
{
  const auto directory = hjt::configurationDirectory("");
  const std::vector<std::string> names = hjt::armsLike(arm, directory);
  if (std::find(names.begin(), names.end(), name) == names.end())
  {
    return {};
  }
  return [directory, names, overrides]
  {
    std::vector<hjt::ArmCandidate> candidates;
    for (const std::string& shipped : names)
    {
      hjt::ArmCandidate& candidate = candidates.emplace_back();
      candidate.name = shipped;
      candidate.arm = hjt::readArmDescription(hjt::findArm(shipped, directory));
      for (const hjt::ArmJoint& joint : candidate.arm.joints)
      {
        hjt::ParameterMap map = hjt::armJointParameters(joint, directory, {});
        hjt::putOver(overrides, map);
        hjt::takeInertiaInLoad(candidate.joints.emplace_back(hjt::parseParameters(map)));
      }
    }
    return candidates;
  };
}

/// Whether the node simulates the arm in place of a robot. @throws ParameterError if input.mode is missing.
bool inPlaceOfArm(const hjt::ParameterMap& overrides)
{
  const auto mode = overrides.find("input.mode");
  if (mode == overrides.end())
  {
    throw hjt::ParameterError(
        "input.mode of an arm is missing. With torque, motion or observer the node runs beside a robot, with commands "
        "in place of the robot");
  }
  const auto* text = std::get_if<std::string>(&mode->second.value);
  return text != nullptr && *text == "commands";
}

/// Adds the driver's prefix and suffix to the names of the arm's joints and of its base frame.
void nameAsInMessages(const hjt::JointAffixes& affixes, hjt::ArmDescription& arm)
{
  for (hjt::ArmJoint& joint : arm.joints)
  {
    joint.name = affixes(joint.name);
  }
  arm.base = affixes.prefix + arm.base;
}

/// Prefix or suffix of the joint names. @throws ParameterError if the resulting names are invalid in ROS.
std::string affixOf(const ros::NodeHandle& node, const std::string& key)
{
  XmlRpc::XmlRpcValue value;
  std::string affix;
  std::string error;
  if (!node.getParam(key, value))
  {
    return affix;
  }
  if (value.getType() == XmlRpc::XmlRpcValue::TypeString)
  {
    affix = static_cast<std::string>(value);
  }
  const bool is_name = value.getType() == XmlRpc::XmlRpcValue::TypeString &&
                       ros::names::validate(key == hjt::PREFIX ? affix + "joint" : "joint" + affix, error);
  if (!is_name)
  {
    throw hjt::ParameterError("~" + key + (affix.empty() ? "" : " = '" + affix + "'") +
                              " must be a text of letters, digits, '_' and '/'; a prefix must begin with a letter");
  }
  return affix;
}

/// Runs the twins of all joints of the arm `asked`. The parameters of the node replace those of the arm's files. The
/// function writes the parameters of each joint to the parameter server, in the namespace of the joint.
void runArm(ros::NodeHandle& node, const std::string& asked, const hjt::FoundParameters& found)
{
  const auto directory = hjt::configurationDirectory("");
  const std::string name = hjt::mainName(asked, directory);
  hjt::ArmDescription arm = hjt::readArmDescription(hjt::findArm(name, directory));
  const std::string description = node.param<std::string>(hjt::DESCRIPTION, "");
  if (!description.empty() && !node.getParam(description, arm.urdf))
  {
    throw hjt::ParameterError("~description: there is no URDF on the parameter server at " + description);
  }
  hjt::readLinks(arm);
  const std::string identified = node.param<std::string>(hjt::IDENTIFIED, "");
  const hjt::JointAffixes affixes{ affixOf(node, hjt::PREFIX), affixOf(node, hjt::SUFFIX) };
  const hjt::ParameterMap overrides = hjt::readParameterServer(node.getNamespace());
  const std::string reference = node.param<std::string>(hjt::REFERENCE, "");
  ROS_INFO_STREAM("Arm " << arm.origin << (identified.empty() ? "" : ", identified: " + identified)
                         << (reference.empty() ? "" : ", reference: " + reference));
  const auto parameters_of = inPlaceOfArm(overrides) ? hjt::armDriveParameters : hjt::armJointParameters;
  std::vector<hjt::ParameterMap> maps;
  for (const hjt::ArmJoint& joint : arm.joints)
  {
    maps.push_back(parameters_of(joint, directory, identified));
    maps.back()["joint.name"].value = affixes(joint.name);
  }
  warnOfParameters(found, node.getNamespace(), maps);
  std::vector<hjt::Parameters> parameters = drivesOf(arm, overrides, std::move(maps));
  if (parameters.front().input.mode == hjt::InputMode::COMMANDS)
  {
    ROS_INFO_STREAM("input.mode is commands: this node replaces the arm and publishes on "
                    << ros::names::resolve(hjt::topics::JOINT_STATES));
    nameAsInMessages(affixes, arm);
    hjt::addIdentifiedGains(identified, arm);
    hjt::giveOwnSeeds(parameters);
    hjt::addArmFaults(arm, itemsOf(node.param<std::string>(hjt::FAULT, "")), parameters);
    run<hjt::ArmWithAction>(node, arm, parameters);
  }
  else
  {
    const bool is_open = identified.empty() && description.empty();
    run<hjt::TrackerNode>(
        node, hjt::TrackerNode::Arm{ arm, parameters, soundJointsOf(reference, arm, parameters), !identified.empty(),
                                     name, is_open ? otherArms(arm, name, overrides) : hjt::ArmWatch::MakeCandidates(),
                                     overrides.count("telemetry.effort") > 0 });
  }
}
}  // namespace

int main(int argc, char** argv)
{
  const hjt::FoundParameters found(argc, argv);
  ros::init(argc, argv, "joint_twin");
  hjt::shutDownOnSignals();
  // The handle must outlive the try block, because ROS and its console shut down with the last handle.
  ros::NodeHandle node("~");
  try
  {
    const std::string arm = node.param<std::string>(hjt::ARM, "");
    arm.empty() ? runJoint(node, found) : runArm(node, arm, found);
  }
  catch (const std::exception& error)  // ParameterError, and errors of ROS
  {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
  return 0;
}
