// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "harmonic_joint_twin/twin/twin.hpp"
#include "live/inbox.hpp"
#include "live/realtime.hpp"
#include "live/twin_loop.hpp"
#include "ros_io/diagnostics.hpp"
#include "ros_io/input_subscribers.hpp"
#include "ros_io/life_publisher.hpp"
#include "ros_io/output_publishers.hpp"
#include "ros_io/timing_publisher.hpp"

namespace hjt
{
/// The live twin: wires a `Twin` to the topics and services of a node. Translates only; computes nothing.
///
/// Threads: the loop advances the twin; a publisher sends what it filled; another ages the drive; the callbacks,
/// diagnostics and services run in whoever spins, at least two threads, since a reset waits for the loop.
class TwinNode
{
public:
  /// Starts at once. @throws ParameterError.
  TwinNode(ros::NodeHandle& node, const Parameters& parameters);

private:
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool setBrake(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);

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
}  // namespace hjt
