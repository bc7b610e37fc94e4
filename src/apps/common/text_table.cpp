// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/text_table.hpp"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace hjt
{
std::string shortNumber(double value)
{
  std::ostringstream text;
  text << std::setprecision(7) << value;
  return text.str();
}

void printValues(const std::vector<NamedValue>& values)
{
  std::size_t name_width = 0;
  std::size_t value_width = 0;
  for (const NamedValue& entry : values)
  {
    name_width = std::max(name_width, entry.name.size());
    value_width = std::max(value_width, entry.value.size());
  }
  for (const NamedValue& entry : values)
  {
    std::cout << std::left << std::setw(static_cast<int>(name_width) + 2) << entry.name << std::right
              << std::setw(static_cast<int>(value_width)) << entry.value << (entry.unit.empty() ? "" : " ")
              << entry.unit << '\n';
  }
}

void printTable(const std::vector<std::string>& headings, const std::vector<std::vector<double>>& rows)
{
  constexpr int NUMBER_WIDTH = 14;
  const auto width = [&](std::size_t column)
  { return std::max(NUMBER_WIDTH, static_cast<int>(headings[column].size()) + 2); };
  for (std::size_t column = 0; column < headings.size(); ++column)
  {
    std::cout << std::setw(width(column)) << headings[column];
  }
  std::cout << '\n';
  for (const auto& row : rows)
  {
    for (std::size_t column = 0; column < row.size(); ++column)
    {
      std::cout << std::setw(width(column)) << shortNumber(row[column]);
    }
    std::cout << '\n';
  }
}
}  // namespace hjt
