// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ros_io/bag_writer.hpp"
#include "ros_io/conversions.hpp"
#include "ros_io/output_schedule.hpp"

namespace hjt
{
/// Writes the twin's topics into a bag: the messages the node would publish, at the same simulated instants.
class BagRecorder
{
public:
  /// Indicators and assessment are only written if the twin watches its signals.
  /// `joint_namespace`: of the node, e.g. "/joint_twin".
  BagRecorder(const Twin& twin, const std::string& joint_namespace, BagWriter& bag);

  /// To be called after every step of the twin.
  void record(Twin& twin);

private:
  BagWriter& bag_;
  OutputSchedule schedule_;
  ToothForces tooth_forces_;
  std::string prefix_;
  JointNames names_;
  std::uint64_t recorded_faults_;  // version of the list that was recorded last
  sensor_msgs::JointState joint_states_;
  harmonic_joint_twin::Encoders encoders_;
  harmonic_joint_twin::ContactForces contact_forces_;
  harmonic_joint_twin::Health health_;
  Stamp health_since_{};  // stamp of the last one [ns]
  harmonic_joint_twin::Indicators indicators_;
  harmonic_joint_twin::Assessment assessment_;
};
}  // namespace hjt
