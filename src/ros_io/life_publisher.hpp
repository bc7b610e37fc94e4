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
/// Counts the drive's use and publishes its remaining life. The thread that runs the twin counts the use. A thread of
/// this class forecasts, publishes and writes the record of use every life.forecast_period in wall clock time, and at
/// the end. A record with an unreadable row is renamed, and the drive then counts as new.
class LifePublisher
{
public:
  /// @throws ParameterError if the file life.use_record exists and is not a record of use.
  LifePublisher(ros::NodeHandle& node, const Parameters& parameters);

  /// Adds the remaining use and writes the record. Must not be called before the last `offer`.
  ~LifePublisher();

  /// For the loop: adds the use since the last call, without allocation or lock. Speed of the motor [rad/s], torque at
  /// the joint [N.m], temperature of the drive [degC]. An assessment is stored if it `supersedes` the stored one.
  void offer(Stamp instant, double motor_velocity, double joint_torque, double temperature,
             const Assessment& assessment) noexcept;

private:
  struct Stretch
  {
    Stamp until;
    UsageHistory use;
    Assessment assessment;  // last stored assessment; the state WAITING means that none was stored
    std::uint64_t windows;  // number of windows of the assessment; the number falls at a reset
  };
  void readRecord();
  void run();
  void takeStretches();
  void publish();
  void write();

  const std::string joint_;
  const LifeParameters parameters_;
  std::string path_;  // path of the record of use; empty: no record
  Stretch counted_;   // use that the loop has counted but not yet handed over
  Stamp counted_from_{};
  Stamp last_{};
  SlotRing<Stretch> stretches_;
  UsageHistory record_;
  Assessment assessment_;
  std::uint64_t windows_{};
  double reference_hours_{};  // use of the drive when the assessment began to learn the reference [h]
  Stamp until_{};
  LifeEstimator estimator_;
  ros::Publisher publisher_;
  std::mutex mutex_;
  std::condition_variable wake_up_;
  bool stopping_{};
  std::thread thread_;
};
}  // namespace hjt
