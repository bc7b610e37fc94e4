// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/time.h>

namespace hjt
{
/// Whether the master that answers has this node in its lists. None that answers is no reason to doubt: connections go
/// on without it.
inline bool isKnownToMaster()
{
  XmlRpc::XmlRpcValue arguments;
  arguments[0] = ros::this_node::getName();
  arguments[1] = ros::this_node::getName();
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue address;
  return ros::master::execute("lookupNode", arguments, response, address, false) || !ros::master::check();
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
