// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "params/field_table.hpp"

namespace hjt
{
/// A row of the field table with its value, as texts.
struct FieldRow
{
  std::string key;
  std::string type;  ///< float, int, N floats, bool or text
  std::string unit;
  std::optional<Range> range;        ///< of numbers
  std::vector<std::string> choices;  ///< of a text that is a choice
  std::string value;                 ///< as YAML has it
  Meaning meaning;
};

std::vector<FieldRow> fieldRows(const Parameters& parameters);
}  // namespace hjt
