// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

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
  double (*value)(const Instant&);                ///< none: a column of numbers per tooth
  std::vector<double> ToothForces::*per_tooth{};  ///< none: one number
};

const std::vector<RunColumn>& columns();

std::string columnNames();  ///< all, for an error text

/// None if there is no column of this name.
const RunColumn* findColumn(const std::string& name);
}  // namespace hjt
