// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <filesystem>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include <ros/ros.h>
#include <rosbag/view.h>
#include <topic_tools/shape_shifter.h>
#include <CLI/CLI.hpp>

#include "harmonic_joint_twin/base/errors.hpp"
#include "ros_io/bag_file.hpp"
#include "ros_io/bag_inputs.hpp"
#include "ros_io/bag_writer.hpp"

namespace
{
using topic_tools::ShapeShifter;

/// Every topic of the bag that is played, and everything the twin puts out beside them.
std::set<std::string> topicsToRecord(const std::string& played_bag, const std::string& twin_namespace)
{
  std::set<std::string> topics{ "/diagnostics" };
  rosbag::Bag bag;
  hjt::openForReading(bag, played_bag);
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
  {
    topics.insert(ros::names::append("/", connection->topic));
  }
  for (const std::string& topic : hjt::outputTopics(twin_namespace))
  {
    topics.insert(topic);
  }
  return topics;
}

/// Records given topics, each message at the time it comes. `rosbag record` cannot serve here: its queues of 100
/// messages lose joint states when the machine stalls for a tenth of a second, and with `--all` on a simulated clock it
/// looks for topics only once the clock runs, and misses what came first. Here queues have no bound.
class TopicRecorder
{
public:
  TopicRecorder(const std::set<std::string>& topics, const std::string& path) : writer_(path)
  {
    for (const std::string& topic : topics)
    {
      constexpr std::uint32_t NO_BOUND = 0;
      subscribers_.push_back(node_.subscribe<ShapeShifter>(
          topic, NO_BOUND, [this, topic](const ShapeShifter::ConstPtr& message) { write(topic, *message); },
          ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
    }
  }

  void close() { writer_.close(); }

private:
  void write(const std::string& topic, const ShapeShifter& message)
  {
    // Before the clock has started there is no time to record at, and a bag takes none before the epoch.
    const ros::Time now = ros::Time::now();
    if (!now.isZero())
    {
      writer_.write(topic, hjt::fromRosTime(now), message);
    }
  }

  hjt::BagWriter writer_;
  ros::NodeHandle node_;
  std::vector<ros::Subscriber> subscribers_;
};

/// FILE_twin.bag beside FILE.bag.
std::string defaultOutput(const std::filesystem::path& played_bag)
{
  const std::string stem = (played_bag.extension() == ".bag" ? played_bag.stem() : played_bag.filename()).string();
  return played_bag.parent_path() / (stem + "_twin.bag");
}

void record(const std::set<std::string>& topics, const std::string& path, bool force)
{
  if (!force && std::filesystem::exists(path))
  {
    throw hjt::InputError(path + " exists already and is not overwritten without --force");
  }
  TopicRecorder recorder(topics, path);
  ros::spin();
  recorder.close();
}
}  // namespace

int main(int argc, char** argv)
{
  ros::init(argc, argv, "replay_recorder");
  // roscpp catches SIGINT only; either ends the recording with the bag closed.
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  std::signal(SIGXFSZ, SIG_IGN);  // beyond a limit of size, writing fails as on a full disk
  CLI::App app("Records the topics of a bag being played, and everything the twin puts out beside them");
  std::string played_bag;
  std::string output_bag;
  std::string twin_namespace = "/joint_twin";
  bool force = false;
  app.add_option("played", played_bag, "the bag being played")->required()->check(CLI::ExistingFile);
  app.add_option("--output", output_bag, "the bag to write; empty: PLAYED_twin.bag beside the one played");
  app.add_option("--joint-namespace", twin_namespace, "of the twin's topics")->capture_default_str();
  app.add_flag("--force", force, "overwrite an existing output");
  CLI11_PARSE(app, argc, argv);
  try
  {
    record(topicsToRecord(played_bag, twin_namespace), output_bag.empty() ? defaultOutput(played_bag) : output_bag,
           force);
  }
  catch (const std::exception& error)
  {
    // Not by ROS' console, which ends with the last node handle.
    std::cerr << "replay_recorder: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
