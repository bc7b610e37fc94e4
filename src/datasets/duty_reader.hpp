// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "datasets/plan_node.hpp"
#include "datasets/plan_values.hpp"
#include "datasets/run_duty.hpp"
#include "datasets/waveform.hpp"
#include "output/ordered_json.hpp"

namespace hjt
{
/// The duty cycles of a plan in one run. All members throw InputError that names file, line, key, value, unit and
/// range.
class DutyReader
{
public:
  /// Reads the tables of a plan's list `duty`, every one that a run may draw. `directory`: where the plan lies.
  void readTables(const PlanNode& duties, const std::string& directory);

  RunDuty read(const PlanNode& duty, const PlanValues& values) const;

  /// The tables' rows, for the plan's document.
  OrderedJson tables() const;

private:
  using Table = std::pair<std::string, std::string>;  // file and column

  std::shared_ptr<const Waveform> waveform(const PlanNode& map, const std::string& key, const PlanValues& values) const;

  std::map<Table, std::shared_ptr<const TableWaveform::Rows>> tables_;
};
}  // namespace hjt
