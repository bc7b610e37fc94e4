// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_recorder.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// The joint at one instant, for the columns of a data set.
struct Instant
{
  JointOutputs outputs;
  EncoderReadings encoders;
  double motor_torque_reading{};  ///< [N.m]
  double speed_reference{};       ///< [rad/s]
};

/// One quantity that can be recorded.
struct RunColumn
{
  const char* name;
  const char* unit;
  const char* meaning;
  double (*value)(const Instant&);                ///< none: a column of numbers per tooth, or of an arm
  std::vector<double> ToothForces::*per_tooth{};  ///< none: one number
  const ArmQuantity* of_arm{};                    ///< none: of one drive

  /// Numbers a row in a run of a drive of so many teeth, or of an arm of so many joints.
  std::size_t width(int teeth, std::size_t joints) const
  {
    return of_arm != nullptr ? of_arm->width(joints) : per_tooth != nullptr ? static_cast<std::size_t>(teeth) : 1;
  }
  bool isTable() const { return of_arm != nullptr || per_tooth != nullptr; }  ///< of several numbers a row
};

const std::vector<RunColumn>& driveColumns();
const std::vector<RunColumn>& armColumns();  ///< in the order of ARM_QUANTITIES
}  // namespace hjt
