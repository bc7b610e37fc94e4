// SPDX-License-Identifier: BSD-3-Clause
#include "output/report.hpp"

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
    // A word longer than the line is not divided.
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

Json Table::rows() const
{
  std::vector<Json> rows;
  for (const std::vector<Json>& cells : cells_)
  {
    Json row;
    for (std::size_t i = 0; i < keys_.size(); ++i)
    {
      if (!keys_[i].empty())
      {
        row[keys_[i]] = cells[i];
      }
    }
    rows.push_back(row);
  }
  return rows;
}

Json Table::columns() const
{
  Json columns;
  for (std::size_t i = 0; i < keys_.size(); ++i)
  {
    std::vector<Json> values;
    for (const std::vector<Json>& cells : cells_)
    {
      values.push_back(cells[i]);
    }
    columns[keys_[i]] = values;
  }
  return columns;
}

void Table::print(std::size_t least_width) const
{
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows(cells_.size());
  for (std::size_t i = 0; i < headings_.size(); ++i)
  {
    if (headings_[i].empty())
    {
      continue;
    }
    headings.push_back(headings_[i]);
    for (std::size_t row = 0; row < rows.size(); ++row)
    {
      rows[row].push_back(cells_[row][i].shortText());
    }
  }
  printTable(headings, rows, least_width);
}

Json documentOf(const Report& report)
{
  Json document;
  for (const ReportLine& line : report.lines)
  {
    if (!line.key.empty())
    {
      document[line.key] = line.value;
    }
  }
  for (const ReportTable& table : report.tables)
  {
    document[table.key] = table.table.rows();
  }
  return document;
}

void printReport(bool json, const std::vector<ReportLine>& lines, const std::vector<ReportTable>& tables)
{
  if (json)
  {
    std::cout << documentOf({ lines, tables }).dump() << '\n';
    return;
  }
  std::vector<NamedValue> values;
  for (const ReportLine& line : lines)
  {
    if (!line.label.empty())
    {
      values.push_back({ line.label, line.value.shortText(), line.unit });
    }
  }
  printValues(values);
  bool first = values.empty();
  for (const ReportTable& table : tables)
  {
    if (!first)
    {
      if (table.table.empty())
      {
        continue;
      }
      std::cout << '\n';
    }
    first = false;
    table.table.print();
  }
}
}  // namespace hjt
