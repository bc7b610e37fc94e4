// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <ros/ros.h>
#include <rosbag/view.h>
#include <topic_tools/shape_shifter.h>

#include "apps/common/command.hpp"
#include "bags/bag_file.hpp"
#include "bags/bag_inputs.hpp"
#include "bags/bag_writer.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/process_end.hpp"
#include "ros_io/node_environment.hpp"

namespace
{
using topic_tools::ShapeShifter;

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

/// Records given topics, each message at the time of reception. `rosbag record` is unsuitable: its queues of 100
/// messages lose joint states if the machine stalls for 0.1 s. With `--all` on a simulated clock `rosbag record`
/// searches for topics only once the clock runs, and misses the first messages.
///
/// Received messages wait in memory for the disk, up to `buffer` bytes. Messages beyond this size are lost and
/// counted.
class TopicRecorder
{
public:
  /// @param buffer largest total size of the messages that wait for the disk [bytes].
  TopicRecorder(const std::set<std::string>& topics, const std::string& path, std::size_t buffer)
    : writer_(path), buffer_(buffer)
  {
    for (const std::string& topic : topics)
    {
      constexpr std::uint32_t NO_BOUND = 0;  // the queue of ROS has no limit, because `receive` empties it at once
      subscribers_.push_back(node_.subscribe<ShapeShifter>(
          topic, NO_BOUND, [this, topic](const ShapeShifter::ConstPtr& message) { receive(topic, message); },
          ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
    }
  }

  /// Records until ROS shuts down. @throws hjt::InputError if not everything could be written.
  void run()
  {
    ros::AsyncSpinner spinner(1);
    spinner.start();
    while (ros::ok())
    {
      writeWaiting();
    }
    spinner.stop();
    writeWaiting();
    writer_.close();
    if (!lost_.empty())
    {
      const auto text = [](const auto& lost) { return std::to_string(lost.second) + " of " + lost.first; };
      throw hjt::InputError("messages arrived faster than they could be written; lost messages: " +
                            hjt::joined(lost_, ", ", text) + ". " + writer_.path() + " has all other messages");
    }
  }

private:
  struct Waiting
  {
    const std::string* topic;
    hjt::Stamp stamp;
    ShapeShifter::ConstPtr message;
  };

  void receive(const std::string& topic, const ShapeShifter::ConstPtr& message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (bytes_ + message->size() > buffer_)
    {
      ++lost_[topic];
      return;
    }
    bytes_ += message->size();
    waiting_.push_back({ &topic, hjt::fromRosTime(ros::Time::now()), message });
    arrived_.notify_one();
  }

  /// Writes the waiting messages, or sleeps if no message waits. A twin whose clock started before that of the recorder
  /// can send messages too early for the recorder. Such a message gets the recorder's first time of the clock.
  void writeWaiting()
  {
    constexpr std::chrono::milliseconds MOMENT{ 50 };
    const hjt::Stamp clock = hjt::fromRosTime(ros::Time::now());
    std::deque<Waiting> taken;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      arrived_.wait_for(lock, MOMENT, [this] { return !waiting_.empty(); });
      if (clock > 0)
      {
        taken.swap(waiting_);
      }
    }
    if (clock == 0)
    {
      std::this_thread::sleep_for(MOMENT / 10);
    }
    for (; !taken.empty(); taken.pop_front())
    {
      const Waiting& next = taken.front();
      writer_.write(*next.topic, next.stamp > 0 ? next.stamp : clock, *next.message);
      const std::lock_guard<std::mutex> lock(mutex_);
      bytes_ -= next.message->size();
    }
  }

  hjt::BagWriter writer_;
  const std::size_t buffer_;
  ros::NodeHandle node_;
  std::mutex mutex_;  // protects the four members below
  std::condition_variable arrived_;
  std::deque<Waiting> waiting_;
  std::size_t bytes_{};  // total size of all messages that wait for the disk [bytes]
  std::map<std::string, std::uint64_t> lost_;
  std::vector<ros::Subscriber> subscribers_;
};

/// Path of the output for the played bag FILE.bag: FILE_twin.bag in the directory of FILE.bag.
std::string defaultOutput(const std::filesystem::path& played_bag)
{
  const std::string stem = (played_bag.extension() == ".bag" ? played_bag.stem() : played_bag.filename()).string();
  return played_bag.parent_path() / (stem + "_twin.bag");
}

void record(const std::set<std::string>& topics, const std::string& path, std::size_t buffer, bool force)
{
  if (!force && std::filesystem::exists(path))
  {
    throw hjt::InputError(path + " exists and is not overwritten without --force");
  }
  TopicRecorder(topics, path, buffer).run();
}
}  // namespace

int main(int argc, char** argv)
{
  ros::init(argc, argv, "replay_recorder");
  hjt::shutDownOnSignals();
  std::string played_bag;
  std::string output_bag;
  std::string twin_namespace = "/joint_twin";
  unsigned buffer = 256;
  bool force = false;
  hjt::CommandLine line("replay_recorder",
                        "Records all topics of a bag that is being played, and all topics that the twin publishes");
  hjt::OptionTable& root = line.root();
  root.add("played", played_bag, "the bag being played").required().existingFile();
  root.add("--output", output_bag, "the bag to write; default: PLAYED_twin.bag in the folder of the played bag");
  root.add("--joint-namespace", twin_namespace, "ROS namespace of the twin's topics");
  root.add("--buffer", buffer,
           "size of the messages that may wait for the disk [MiB]; further messages are lost, counted and reported")
      .range(1, 1U << 20U);
  root.flag("--force", force, "overwrite an existing output");
  if (const std::optional<int> ended = line.parse(argc, argv))
  {
    return *ended;
  }
  try
  {
    record(topicsToRecord(played_bag, twin_namespace), output_bag.empty() ? defaultOutput(played_bag) : output_bag,
           std::size_t{ buffer } * 1024 * 1024, force);
  }
  catch (const std::exception& error)
  {
    // The console of ROS ends with the last node handle, so it cannot print this error.
    std::cerr << "replay_recorder: " << error.what() << '\n';
    return hjt::EXIT_FAILED;
  }
  return hjt::EXIT_DONE;
}
