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

void printTable(const std::vector<std::string>& headings, const std::vector<std::vector<std::string>>& rows,
                std::size_t least_width)
{
  constexpr std::size_t GAP = 2;
  std::vector<int> widths;
  for (std::size_t column = 0; column < headings.size(); ++column)
  {
    std::size_t width = std::max(least_width, headings[column].size() + GAP);
    for (const auto& row : rows)
    {
      width = std::max(width, row[column].size() + (column > 0 ? GAP : 0));
    }
    widths.push_back(static_cast<int>(width));
  }
  const auto print = [&widths](const std::vector<std::string>& cells)
  {
    for (std::size_t column = 0; column < cells.size(); ++column)
    {
      std::cout << std::setw(widths[column]) << cells[column];
    }
    std::cout << '\n';
  };
  print(headings);
  std::for_each(rows.begin(), rows.end(), print);
}
}  // namespace hjt
