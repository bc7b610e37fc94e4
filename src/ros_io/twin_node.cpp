// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/twin_node.hpp"

#include "ros_io/live_loop.hpp"
#include "ros_io/node_surface_source.hpp"

namespace hjt
{
namespace
{
Twin watchedTwin(const Parameters& parameters)
{
  // In simulated time the twin waits for its surface, so that a replay gives the same bits every time.
  Twin twin(parameters, nodeSurfaceSource(!ros::Time::isSimTime()));
  twin.watchSignals(true);
  return twin;
}
}  // namespace

TwinNode::TwinNode(ros::NodeHandle& node, const Parameters& parameters)
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

bool TwinNode::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  response.success = loop_.reset();
  response.message = response.success ? "the twin restarts at the current instant" : "the loop does not answer";
  return true;
}

bool TwinNode::setBrake(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response)
{
  inbox_.push(Input{ rosNow(), InputKind::BRAKE, request.data ? 1.0 : 0.0 });
  response.success = true;
  response.message = request.data ? "brake engages" : "brake releases";
  return true;
}
}  // namespace hjt
