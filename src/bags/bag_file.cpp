// SPDX-License-Identifier: BSD-3-Clause
#include "bags/bag_file.hpp"

#include <map>

#include <console_bridge/console.h>
#include <rosbag/view.h>

#include "bags/bag_check.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
void openForReading(rosbag::Bag& bag, const std::string& path)
{
  checkBagFile(path);
  // As in BagWriter.
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_WARN);
  try
  {
    bag.open(path, rosbag::bagmode::Read);
  }
  catch (const rosbag::BagUnindexedException&)
  {
    throw InputError(path + " was not closed properly and has no index; `rosbag reindex` may mend it");
  }
  catch (const std::exception& error)
  {
    throw InputError(path + " cannot be read as a bag: " + error.what());
  }
}

void refuseTopics(const rosbag::Bag& bag, const std::string& path, const std::vector<std::string>& topics)
{
  rosbag::View view(bag, rosbag::TopicQuery(topics));
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
  {
    throw InputError(path + " holds " + connection->topic +
                     " already; leave it out, or choose another --joint-namespace");
  }
}

std::string listTopics(const rosbag::Bag& bag)
{
  std::map<std::string, std::string> types;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
  {
    types[connection->topic] = connection->datatype;
  }
  std::string text;
  for (const auto& [topic, type] : types)
  {
    text += "\n  " + topic + " (" + type + ")";
  }
  return text;
}
}  // namespace hjt
