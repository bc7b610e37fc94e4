// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "datasets/columns.hpp"
#include "datasets/plan_node.hpp"
#include "datasets/plan_values.hpp"

#include "base/joined.hpp"

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

/// The columns of a group, out of those `known`. @throws InputError naming file and line.
inline std::vector<const RunColumn*> readColumns(const PlanNode& group, const std::vector<RunColumn>& known)
{
  std::vector<const RunColumn*> columns;
  const PlanNode& list = required(group, "columns", PlanNode::Kind::LIST);
  for (const auto& [key, element] : list.entries)
  {
    const std::string wanted = PlanValues().text(list, key);
    const auto column =
        std::find_if(known.begin(), known.end(), [&](const RunColumn& each) { return each.name == wanted; });
    if (column == known.end())
    {
      const auto name_of = [](const RunColumn& each) { return each.name; };
      element.refuse("is no column; there are " + joined(known, ", ", name_of));
    }
    if (std::find(columns.begin(), columns.end(), &*column) != columns.end())
    {
      element.refuse("stands twice");
    }
    columns.push_back(&*column);
  }
  return columns;
}

/// The plan's mapping `record`; `of_arms`: of a plan of whole arms. @throws InputError naming file and line.
inline Recording readRecording(const PlanNode& record, bool of_arms)
{
  const PlanValues values;
  Recording recording;
  const std::string format = values.text(record, "format", "hdf5");
  if (format == "bag")
  {
    allowOnly(record, { "format" });
    recording.format = RunFormat::BAG;
    return recording;
  }
  if (format != "hdf5")
  {
    required(record, "format").refuse("is unknown; allowed: hdf5, bag");
  }
  if (!hasHdf5())
  {
    record.refuse("needs format: bag; hdf5 is not built: it needs HDF5");
  }
  allowOnly(record, { "format", "start", "deflate", "indicators", "groups" });
  recording.indicators = values.flag(record, "indicators");
  if (recording.indicators && of_arms)
  {
    required(record, "indicators").refuse("are those of one drive, not of an arm: `joint_twin indicators` makes them");
  }
  const std::vector<RunColumn>& known = of_arms ? armColumns() : driveColumns();
  constexpr double START = 1.0;  // [s]
  constexpr int DEFLATE = 4;
  recording.start = values.number(record, "start", "s", { 0, 1e6 }, START);
  recording.deflate = static_cast<int>(values.whole(record, "deflate", "-", { 0, 9 }, DEFLATE));
  for (const auto& [name, node] : required(record, "groups", PlanNode::Kind::MAP).entries)
  {
    allowOnly(node, { "rate", "type", "columns" });
    RecordingGroup group{ name, values.number(node, "rate", "Hz", { 1e-3, 1e6 }), false, {} };
    const std::string type = values.text(node, "type", "float64");
    if (type != "float32" && type != "float64")
    {
      required(node, "type").refuse("is unknown; allowed: float32, float64");
    }
    group.float32 = type == "float32";
    group.columns = readColumns(node, known);
    if (name == "faults" || name == "parameters" || name == "indicators" || name == "record" ||
        name.find('/') != std::string::npos || group.columns.empty())
    {
      node.refuse(
          "needs at least one column, and a name other than faults, parameters, indicators and record, without '/'");
    }
    recording.groups.push_back(group);
  }
  return recording;
}
}  // namespace hjt
