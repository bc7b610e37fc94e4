// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "ros_io/conversions.hpp"
#include "ros_io/stamp_periods.hpp"
#include "sensors/joint_sensors.hpp"
#include "tracking/measured_gear.hpp"
#include "tracking/tracker.hpp"

namespace hjt
{
/// Contact forces, encoders and health of the drive beside a robot: of the gear at the measured angle under the joint's
/// torque of the moment. Nothing is solved that nobody hears.
class MeasuredGearPublisher
{
public:
  /// @throws ParameterError as MeasuredGear.
  MeasuredGearPublisher(ros::NodeHandle& node, const Parameters& parameters);

  /// After each comparison: publishes the messages that are due and have subscribers.
  void offer(Stamp stamp, const Comparison& comparison);

  std::uint64_t failures() const { return failures_; }  ///< instants without an equilibrium

private:
  template <class Message>
  struct Topic
  {
    Message message;
    StampPeriods periods;
    ros::Publisher publisher;

    bool isDue(Stamp stamp) { return periods.begins(stamp) && publisher.getNumSubscribers() > 0; }
  };

  void fillHealth(Stamp stamp, const Comparison& comparison);

  const double torque_per_current_;  // at the motor [N.m/A]
  const double current_offset_;      // [A]
  const double ratio_;
  MeasuredGear gear_;
  JointSensors sensors_;
  Topic<harmonic_joint_twin::ContactForces> contact_forces_;
  Topic<harmonic_joint_twin::Encoders> encoders_;
  Topic<harmonic_joint_twin::Health> health_;
  std::uint64_t failures_{};
};
}  // namespace hjt
