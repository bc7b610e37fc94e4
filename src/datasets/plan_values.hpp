// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/plan_node.hpp"

#include "params/field_table.hpp"

namespace hjt
{
/// The plan in one run: each variable has its value. All members throw InputError that names file, line, key,
/// value, unit and range.
class PlanValues
{
public:
  /// A variable stands for this value.
  void set(const PlanNode& variable, ParameterValue value) { drawn_[&variable] = std::move(value); }

  // `otherwise`: where the key is left out; none: it must be there.
  double number(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                std::optional<double> otherwise = std::nullopt) const;
  std::int64_t whole(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                     std::optional<std::int64_t> otherwise = std::nullopt) const;
  std::string text(const PlanNode& map, const std::string& key,
                   const std::optional<std::string>& otherwise = std::nullopt) const;
  bool flag(const PlanNode& map, const std::string& key) const;  ///< false where the key is left out

  /// A plain value, a variable's or a list of numbers.
  ParameterValue value(const PlanNode& node) const;

private:
  std::map<const PlanNode*, ParameterValue> drawn_;
};

/// @throws InputError if the key is not there.
const PlanNode& required(const PlanNode& map, std::string_view key);
const PlanNode& required(const PlanNode& map, std::string_view key, PlanNode::Kind kind);

/// @throws InputError if the node is no mapping, or has a key that is not among these.
void allowOnly(const PlanNode& map, const std::vector<std::string>& keys);
}  // namespace hjt
