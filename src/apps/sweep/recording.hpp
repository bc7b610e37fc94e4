// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "apps/sweep/columns.hpp"
#include "apps/sweep/plan_node.hpp"

namespace hjt
{
/// Columns that are recorded at one rate.
struct RecordingGroup
{
  std::string name;
  double rate{};   // [Hz]
  bool float32{};  // else float64
  std::vector<const RunColumn*> columns;
};

enum class RunFormat
{
  HDF5,
  BAG
};

struct Recording
{
  RunFormat format{};
  double start{};     ///< nothing is recorded before [s]
  int deflate{};      ///< 0 ... 9; 0: not compressed
  bool indicators{};  ///< those of docs/indicators.md, a row a window
  std::vector<RecordingGroup> groups;
};

/// The plan's mapping `record`. @throws InputError naming file and line.
Recording readRecording(const PlanNode& record);
}  // namespace hjt
