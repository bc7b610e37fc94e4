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
/// Text of a number with seven digits, for people.
std::string shortNumber(double value);

/// A named value with unit, which is printed on a separate line.
struct NamedValue
{
  std::string name;
  std::string value;
  std::string unit;
};
void printValues(const std::vector<NamedValue>& values);

/// Prints a text in lines of at most 100 columns. All lines except the first have `indent` more columns of indentation.
void printWrapped(const std::string& text, std::size_t indent);

constexpr std::size_t NUMBER_WIDTH = 14;

/// Prints rows under headings ("torque [N.m]") in aligned columns of at least `least_width` characters.
void printTable(const std::vector<std::string>& headings, const std::vector<std::vector<std::string>>& rows,
                std::size_t least_width = NUMBER_WIDTH);

/// A column of a table with rows of type `Row`.
template <class Row>
struct Column
{
  std::string key;                        ///< key in documents and files; empty: the column is not in them
  std::function<Json(const Row&)> value;  ///< member of a row, or function that computes the value from a row
  std::string heading{};                  ///< heading with unit ("torque [N.m]"); empty: people do not see the column
};

/// A table with named columns, for people, as a document or as a file.
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
  Json rows() const;                                         ///< the table as one object for each row
  Json columns() const;                                      ///< the table as one array for each column
  void print(std::size_t least_width = NUMBER_WIDTH) const;  ///< prints columns of at least `least_width` characters

private:
  std::vector<std::string> keys_;
  std::vector<std::string> headings_;
  std::vector<std::vector<Json>> cells_;
};

/// A CSV file of numbers, written row by row.
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

  /// @throws InputError if not everything could be written.
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

/// Writes all rows to a CSV file. An empty path means that the option was not given, and nothing is written. @throws
/// InputError if the file cannot be written.
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

struct ReportLine
{
  std::string key;    ///< key in the document ("peak.torque" is a member of "peak"); empty: only for people
  std::string label;  ///< label that people see; empty: the value is only in the document
  Json value;
  std::string unit{};
};

struct ReportTable
{
  std::string key;
  Table table;
};

struct Report
{
  std::vector<ReportLine> lines;
  std::vector<ReportTable> tables;
};

Json documentOf(const Report& report);

/// Prints a report to stdout: for people as lines and tables, or as one JSON document.
void printReport(bool json, const std::vector<ReportLine>& lines, const std::vector<ReportTable>& tables = {});
}  // namespace hjt
