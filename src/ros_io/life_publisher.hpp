// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "harmonic_joint_twin/RemainingLife.h"
#include "harmonic_joint_twin/twin/input_queue.hpp"
#include "life/life_estimate.hpp"
#include "live/thread_exchange.hpp"

namespace hjt
{
/// Keeps the drive's record of use and publishes what is left of its life. The thread that runs the twin counts the
/// use. A thread of this class forecasts, publishes and writes the file every life.forecast_period by the wall clock,
/// and at the end.
///
/// A record with a row that cannot be read is renamed, and the count restarts.
class LifePublisher
{
public:
  /// @throws ParameterError if life.use_record is there and no record.
  LifePublisher(ros::NodeHandle& node, const Parameters& parameters);

  /// After the last `offer`: takes in what was counted, and writes.
  ~LifePublisher();

  /// One thread, the loop's: counts the time since the last call. No allocation, no lock.
  /// Speed of the motor [rad/s], torque at the joint [N.m], temperature of the drive [degC]; the assessment counts if
  /// it `supersedes` those before.
  void offer(Stamp instant, double motor_velocity, double joint_torque, double temperature,
             const Assessment& assessment) noexcept;

private:
  struct Stretch
  {
    Stamp until;
    UsageHistory use;
    Assessment assessment;  // the last one that counts; of none its state is WAITING
    std::uint64_t windows;  // of the assessment: fewer than before after a reset
  };
  void readRecord();
  void run();
  void takeStretches();
  void publish();
  void write();

  const std::string joint_;
  const LifeParameters parameters_;
  std::string path_;  // of the record; empty: none
  Stretch counted_;   // by the loop, not yet handed over
  Stamp counted_from_{};
  Stamp last_{};
  SlotRing<Stretch> stretches_;
  UsageHistory record_;
  Assessment assessment_;
  std::uint64_t windows_{};
  double reference_hours_{};  // of use, when the assessment began to learn its reference
  Stamp until_{};
  LifeEstimator estimator_;
  ros::Publisher publisher_;
  std::mutex mutex_;
  std::condition_variable wake_up_;
  bool stopping_{};
  std::thread thread_;
};
}  // namespace hjt
