// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "output/ordered_json.hpp"

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// One place of a plan's file. Read once, then used read-only from any thread.
struct PlanNode
{
  enum class Kind
  {
    SCALAR,
    LIST,
    MAP
  };
  using Entry = std::pair<std::string, PlanNode>;

  Kind kind{};
  std::string path;            ///< keys from the top, joined by dots
  std::string origin;          ///< file:line
  ParameterValue scalar;       ///< of a SCALAR
  std::vector<Entry> entries;  ///< of a MAP; of a LIST under "0", "1", ...

  const PlanNode* find(std::string_view key) const;

  /// @throws InputError that names this place.
  [[noreturn]] void refuse(const std::string& what) const;
};

/// The value as a number, whole or not; nothing if it is no number.
std::optional<double> numberIn(const ParameterValue& value);

OrderedJson jsonOf(const ParameterValue& value);
OrderedJson jsonOf(const PlanNode& node);

/// @throws InputError naming file and line.
PlanNode readPlanFile(const std::string& path);
}  // namespace hjt
