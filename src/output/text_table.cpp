// SPDX-License-Identifier: BSD-3-Clause
#include "output/text_table.hpp"

#include <algorithm>
#include <iomanip>
#include <iostream>

#include "base/number_text.hpp"

namespace hjt
{
std::string shortNumber(double value)
{
  return roundedText(value, 7);
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

void printWrapped(const std::string& text, std::size_t indent)
{
  constexpr std::size_t WIDTH = 100;
  std::string margin(indent, ' ');
  for (std::size_t begin = 0; begin < text.size();)
  {
    const std::size_t room = WIDTH - margin.size();
    const std::size_t blank = text.size() - begin > room ? text.rfind(' ', begin + room) : text.size();
    // A word longer than the line stays whole.
    const std::size_t end = blank == std::string::npos || blank <= begin ? text.find(' ', begin) : blank;
    std::cout << margin << text.substr(begin, end - begin) << '\n';
    begin = end == std::string::npos ? text.size() : end + 1;
    margin.assign(indent + 2, ' ');
  }
}

void printTable(const std::vector<std::string>& headings, const std::vector<std::vector<std::string>>& rows)
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
      // A text may be longer than its heading.
      const bool is_long = static_cast<int>(row[column].size()) >= width(column);
      std::cout << (is_long && column > 0 ? "  " : "") << std::setw(width(column)) << row[column];
    }
    std::cout << '\n';
  }
}
}  // namespace hjt
