// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "arm/arm_recorder.hpp"
#include "datasets/plan_values.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// State of the joint at one instant, for the columns of a data set.
struct Instant
{
  JointOutputs outputs;
  EncoderReadings encoders;
  double motor_torque_reading{};  ///< [N.m]
  double speed_reference{};       ///< [rad/s]
};

/// A quantity that can be recorded.
struct RunColumn
{
  const char* name;
  const char* unit;
  const char* meaning;
  double (*value)(const Instant&);                ///< null: a column for each tooth, or of an arm
  std::vector<double> ToothForces::*per_tooth{};  ///< null: one number
  const ArmQuantity* of_arm{};                    ///< null: a quantity of one drive

  /// Number of values in a row, in a run of a drive with `teeth` or of an arm with `joints`.
  std::size_t width(int teeth, std::size_t joints) const
  {
    return of_arm != nullptr ? of_arm->width(joints) : per_tooth != nullptr ? static_cast<std::size_t>(teeth) : 1;
  }
  bool isTable() const { return of_arm != nullptr || per_tooth != nullptr; }  ///< whether a row has several numbers
};

const std::vector<RunColumn>& driveColumns();

const std::vector<RunColumn>& armColumns();  ///< in the order of ARM_QUANTITIES

/// Columns that are recorded at the same rate.
struct RecordingGroup
{
  std::string name;
  double rate{};   // [Hz]
  bool float32{};  // otherwise float64
  std::vector<const RunColumn*> columns;
};

/// Whether this build supports HDF5 files.
bool hasHdf5();

enum class RunFormat
{
  HDF5,
  BAG
};

struct Recording
{
  RunFormat format{};
  double start{};     ///< start of the recording; in the first half of this time the inputs increase gradually [s]
  int deflate{};      ///< compression level 0 ... 9; 0: none
  bool indicators{};  ///< record the indicators of docs/indicators.md, one row for each window
  std::vector<RecordingGroup> groups;
};

/// Reads the plan's mapping `record`; `of_arms`: in a plan of whole arms. @throws InputError with file and line.
Recording readRecording(const PlanNode& record, bool of_arms);
}  // namespace hjt
