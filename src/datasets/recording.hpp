// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_recorder.hpp"
#include "datasets/plan_values.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// State of the drive at one instant, from which the values in the columns of a data set are computed.
struct Instant
{
  JointOutputs outputs;
  EncoderReadings encoders;
  double motor_torque_reading{};  ///< motor torque as estimated from the current [N.m]
  double speed_reference{};       ///< reference of the joint's speed [rad/s]
};

/// A quantity that can be a column of a data set.
struct RunColumn
{
  const char* name;
  const char* unit;
  const char* meaning;
  double (*value)(const Instant&);  ///< function for a single number; null for a quantity of teeth or of an arm
  std::vector<double> ToothForces::*per_tooth{};  ///< vector with a number for each tooth; null for other quantities
  const ArmQuantity* of_arm{};                    ///< quantity of an arm; null for a quantity of one drive

  /// Number of values in a row, for a run of a drive with `teeth` teeth or of an arm with `joints` joints.
  std::size_t width(int teeth, std::size_t joints) const
  {
    return of_arm != nullptr ? of_arm->width(joints) : per_tooth != nullptr ? static_cast<std::size_t>(teeth) : 1;
  }
  bool isTable() const { return of_arm != nullptr || per_tooth != nullptr; }  ///< whether a row has several numbers
};

const std::vector<RunColumn>& driveColumns();

const std::vector<RunColumn>& armColumns();  ///< columns for an arm, in the order of ARM_QUANTITIES

/// Columns of a data set that are recorded at the same rate.
struct RecordingGroup
{
  std::string name;
  double rate{};   // rate of the rows [Hz]
  bool float32{};  // whether a number has 32 bits in the file; false: 64 bits
  std::vector<const RunColumn*> columns;
};

bool hasHdf5();

enum class RunFormat
{
  HDF5,
  BAG
};

struct Recording
{
  RunFormat format{};
  double start{};     ///< time before the first row; in its first half the inputs increase gradually [s]
  int deflate{};      ///< compression level from 0 to 9; 0: no compression
  bool indicators{};  ///< whether the indicators of docs/indicators.md are recorded, with one row for each window
  std::vector<RecordingGroup> groups;
};

/// Reads the plan's mapping `record`. `of_arms`: whether it is a plan of arms. @throws InputError with file and line.
Recording readRecording(const PlanNode& record, bool of_arms);
}  // namespace hjt
