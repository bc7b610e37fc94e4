// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/wall_timer.h>

#include "harmonic_joint_twin/Timing.h"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "live/twin_loop.hpp"

namespace hjt
{
/// Publishes how the loop keeps up, once a second by the wall clock, to those who listen.
class TimingPublisher
{
public:
  TimingPublisher(ros::NodeHandle& node, const Parameters& parameters, const TwinLoop& loop);

private:
  void publish();

  const TwinLoop& loop_;
  harmonic_joint_twin::Timing message_;
  ros::Publisher publisher_;
  ros::WallTimer timer_;
};
}  // namespace hjt
