// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_recorder.hpp"
#include "datasets/plan_values.hpp"
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

/// Columns that are recorded at one rate.
struct RecordingGroup
{
  std::string name;
  double rate{};   // [Hz]
  bool float32{};  // else float64
  std::vector<const RunColumn*> columns;
};

/// This build writes and reads HDF5 files.
bool hasHdf5();

enum class RunFormat
{
  HDF5,
  BAG
};

struct Recording
{
  RunFormat format{};
  double start{};     ///< nothing is recorded before; what drives the joint comes in gently in its first half [s]
  int deflate{};      ///< 0 ... 9; 0: not compressed
  bool indicators{};  ///< those of docs/indicators.md, a row a window
  std::vector<RecordingGroup> groups;
};

/// The plan's mapping `record`; `of_arms`: of a plan of whole arms. @throws InputError naming file and line.
Recording readRecording(const PlanNode& record, bool of_arms);
}  // namespace hjt
