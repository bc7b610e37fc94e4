// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/time.h>

namespace hjt
{
/// Whether `topic` of the publishers in a master's state has this node.
inline bool hasThisNode(XmlRpc::XmlRpcValue& publishers, const std::string& topic)
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

/// Whether the master that answers has all topics of this node: one that came while the node started has the last of
/// them alone. None that answers is no reason to doubt: connections go on without it.
inline bool isKnownToMaster()
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

/// Until the node is told to end: true. False: another master has come, which knows nothing of the node, so that nobody
/// can find its topics. It would have to be given its parameters and registrations again; a new start does that.
inline bool waitForShutdownOrNewMaster()
{
  constexpr int LOOKS = 100;  // of which one at the master
  constexpr int MISSES = 2;   // in a row: one alone may be a master that is just starting or ending
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
}  // namespace hjt
