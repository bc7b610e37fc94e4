// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/wall_timer.h>

#include "harmonic_joint_twin/Timing.h"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "live/twin_loop.hpp"
#include "messages/time.hpp"
#include "messages/topics.hpp"

namespace hjt
{
/// Publishes how the loop keeps up, once a second by the wall clock, to those who listen.
class TimingPublisher
{
public:
  TimingPublisher(ros::NodeHandle& node, const Parameters& parameters, const TwinLoop& loop)
    : loop_(loop), publisher_(node.advertise<harmonic_joint_twin::Timing>(topics::TIMING, QUEUE_LENGTH))
  {
    message_.header.frame_id = parameters.joint.name;
    message_.deadline = parameters.realtime.deadline;
    for (std::size_t bin = 0; bin < LatencyHistogram::BIN_COUNT; ++bin)
    {
      message_.bin_end.push_back(toSeconds(LatencyHistogram::binEnd(bin)));
    }
    timer_ = node.createWallTimer(ros::WallDuration(PERIOD), [this](const ros::WallTimerEvent&) { publish(); });
  }

private:
  static constexpr double PERIOD = 1.0;  // by the wall clock [s]
  static constexpr std::uint32_t QUEUE_LENGTH = 10;

  void publish()
  {
    if (publisher_.getNumSubscribers() == 0)
    {
      return;
    }
    const LoopTiming timing = loop_.status().timing;
    message_.header.stamp = ros::Time::now();
    message_.duration = toSeconds(timing.elapsed);
    message_.real_time_factor = timing.realTimeFactor();
    message_.load = timing.load();
    message_.longest_cycle = toSeconds(timing.longest_cycle);
    message_.missed_deadlines = timing.missed_deadlines;
    message_.wake_up_median = toSeconds(timing.wake_up.quantile(0.5));
    message_.wake_up_p99 = toSeconds(timing.wake_up.quantile(0.99));
    message_.wake_up_p999 = toSeconds(timing.wake_up.quantile(0.999));
    message_.wake_up_max = toSeconds(timing.wake_up.largest());
    message_.lateness_median = toSeconds(timing.lateness.quantile(0.5));
    message_.lateness_p99 = toSeconds(timing.lateness.quantile(0.99));
    message_.lateness_p999 = toSeconds(timing.lateness.quantile(0.999));
    message_.lateness_max = toSeconds(timing.lateness.largest());
    message_.wake_up_count.assign(timing.wake_up.bins().begin(), timing.wake_up.bins().end());
    message_.lateness_count.assign(timing.lateness.bins().begin(), timing.lateness.bins().end());
    publisher_.publish(message_);
  }

  const TwinLoop& loop_;
  harmonic_joint_twin::Timing message_;
  ros::Publisher publisher_;
  ros::WallTimer timer_;
};
}  // namespace hjt
