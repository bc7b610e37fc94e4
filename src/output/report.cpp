// SPDX-License-Identifier: BSD-3-Clause
#include "output/report.hpp"

#include <iostream>

namespace hjt
{
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
