// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "output/json.hpp"
#include "output/output_file.hpp"

namespace hjt
{
/// A number for people: seven digits.
std::string shortNumber(double value);

/// Prints named values with units, one a line.
struct NamedValue
{
  std::string name;
  std::string value;
  std::string unit;
};
void printValues(const std::vector<NamedValue>& values);

/// Prints a text in lines of at most 100 columns, those after the first indented by `indent` more than it.
void printWrapped(const std::string& text, std::size_t indent);

/// Width of a column of numbers.
constexpr std::size_t NUMBER_WIDTH = 14;

/// Prints rows under headings ("torque [N.m]"), columns aligned, each at least so wide.
void printTable(const std::vector<std::string>& headings, const std::vector<std::vector<std::string>>& rows,
                std::size_t least_width = NUMBER_WIDTH);

/// One column of a table of `Row`s.
template <class Row>
struct Column
{
  std::string key;                        ///< in documents and files; empty: left out there
  std::function<Json(const Row&)> value;  ///< a member, or what a function makes of the row
  std::string heading{};                  ///< for people, with the unit: "torque [N.m]"; empty: left out there
};

/// Rows of named values, for people, as a document or as a file.
class Table
{
public:
  template <class Row, class Rows>
  Table(const std::vector<Column<Row>>& columns, const Rows& rows)
  {
    for (const Column<Row>& column : columns)
    {
      keys_.push_back(column.key);
      headings_.push_back(column.heading);
    }
    for (const Row& row : rows)
    {
      cells_.emplace_back();
      for (const Column<Row>& column : columns)
      {
        cells_.back().push_back(column.value(row));
      }
    }
  }

  bool empty() const { return cells_.empty(); }
  Json rows() const;                                         ///< one object a row
  Json columns() const;                                      ///< one array a column
  void print(std::size_t least_width = NUMBER_WIDTH) const;  ///< each column at least so wide

private:
  std::vector<std::string> keys_;
  std::vector<std::string> headings_;
  std::vector<std::vector<Json>> cells_;
};

/// Columns of numbers as a CSV file, row by row.
template <class Row>
class TableFile
{
public:
  /// @throws InputError if the file cannot be written.
  TableFile(const std::string& path, std::vector<Column<Row>> columns)
    : columns_(std::move(columns)), csv_(path, keys())
  {
  }

  void write(const Row& row)
  {
    std::vector<double> values;
    for (const Column<Row>& column : columns_)
    {
      values.push_back(column.value(row).number());
    }
    csv_.writeRow(values);
  }

  /// @throws InputError if not all could be written.
  void close() { csv_.close(); }

private:
  std::vector<std::string> keys() const
  {
    std::vector<std::string> keys;
    for (const Column<Row>& column : columns_)
    {
      keys.push_back(column.key);
    }
    return keys;
  }

  const std::vector<Column<Row>> columns_;
  CsvWriter csv_;
};

/// All rows as a CSV file; none if the path is empty, of an option that was left out. @throws InputError if it cannot
/// be written.
template <class Row, class Rows>
void writeTable(const std::string& path, const std::vector<Column<Row>>& columns, const Rows& rows)
{
  if (path.empty())
  {
    return;
  }
  TableFile<Row> file(path, columns);
  for (const Row& row : rows)
  {
    file.write(row);
  }
  file.close();
}

/// One value of a report.
struct ReportLine
{
  std::string key;    ///< in the document, dots going deeper; empty: for people only
  std::string label;  ///< for people; empty: in the document only
  Json value;
  std::string unit{};
};

struct ReportTable
{
  std::string key;
  Table table;
};

/// Result of a function.
struct Report
{
  std::vector<ReportLine> lines;
  std::vector<ReportTable> tables;
};

Json documentOf(const Report& report);

/// On stdout as lines and tables for people, or as one JSON document.
void printReport(bool json, const std::vector<ReportLine>& lines, const std::vector<ReportTable>& tables = {});
}  // namespace hjt
