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
#include "ros_io/live_loop.hpp"
#include "ros_io/node_surface_source.hpp"
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
    // In simulated time the twin waits for its surface, so that a replay gives the same bits every time.
    Twin twin(parameters, nodeSurfaceSource(!ros::Time::isSimTime()));
    twin.watchSignals(true);
    return twin;
  }

  bool reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
  {
    response.success = loop_.reset();
    response.message = response.success ? "the twin restarts at the current instant" : "the loop does not answer";
    return true;
  }

  bool setBrake(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response)
  {
    inbox_.push(Input{ rosNow(), InputKind::BRAKE, request.data ? 1.0 : 0.0 });
    response.success = true;
    response.message = request.data ? "brake engages" : "brake releases";
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
}  // namespace hjt
