// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/range.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
/// Reads the rows of a text table with a header. The header shows whether commas, semicolons, tabs or blanks separate
/// the columns. The reader skips blanks and quotes around a text, a byte order mark, a carriage return at the end of a
/// line, and a # before the header. A comma within quotes, or in a table with another separator, is a decimal comma.
/// The reader also skips empty lines, lines that begin with #, and empty texts beyond the columns of the header.
class CsvRows
{
public:
  /// Reads the header. @throws InputError if the file is empty or unreadable.
  explicit CsvRows(const std::string& path);

  const std::vector<std::string>& header() const { return header_; }

  /// Reads the next row. @returns false at the end. @throws InputError that names a line with a wrong number of
  /// columns.
  bool next();

  /// Accepts a last line with too few columns, which an interrupted writer leaves, as the end of the file.
  void allowCutOff() { allows_cut_off_ = true; }
  /// Whether the last line had too few columns and was skipped for this reason.
  bool wasCutOff() const { return was_cut_off_; }

  /// Accepts a wrong number of columns in other lines too. The texts of such a row are empty.
  void allowUneven() { allows_uneven_ = true; }
  /// Clause on the numbers of columns in the header and in the last wrong line; empty if all lines are right.
  std::string unevenText() const;

  /// Plural of the separator's name, for example "commas".
  const char* separatorName() const;

  /// Text in a column of the last row. It is valid until the next row is read.
  const char* text(std::size_t column) const { return texts_[column]; }
  /// Number in a column of the last row. @throws InputError that names the line if the text is not a finite number.
  double number(std::size_t column) const;

  /// File and line of the last row, as FILE:LINE.
  std::string place() const { return path_ + ":" + std::to_string(line_number_); }

private:
  void findLineEnd();
  void readHeader();
  bool readLine();
  void findSeparator();
  void split();
  void splitAtBlanks(char* begin, char* end);

  std::string path_;
  std::ifstream file_;
  std::vector<char> line_;
  std::size_t length_ = 0;  // length of the last line [byte]
  std::size_t line_number_ = 0;
  char line_end_ = '\n';
  char separator_ = ',';
  bool allows_cut_off_ = false;
  bool allows_uneven_ = false;
  bool was_cut_off_ = false;
  std::size_t uneven_columns_ = 0;  // number of columns in the last wrong line
  std::vector<std::string> header_;
  std::vector<const char*> texts_;
};

/// Reads N named columns with finite numbers from a table with a header. Other columns are skipped. In the last
/// `lenient` columns, a text that is not a finite number becomes NaN.
template <std::size_t N>
class NumberTable
{
public:
  using Names = std::array<std::string, N>;

  /// Function that replaces other names of the columns by the names that the reader knows.
  using Translate = std::vector<std::string> (*)(std::vector<std::string> header);

  /// Reads the header. The last `optional` columns may be missing. @throws InputError if the file is unreadable or the
  /// header lacks columns; the text names all missing columns.
  NumberTable(const std::string& path, const Names& names, std::size_t optional = 0, std::size_t lenient = 0,
              Translate translate = nullptr)
    : names_(names), strict_(N - lenient), rows_(path)
  {
    const std::vector<std::string> header = translate != nullptr ? translate(rows_.header()) : rows_.header();
    std::vector<std::string> missing;
    for (std::size_t i = 0; i < N; ++i)
    {
      const auto found = std::find(header.begin(), header.end(), names[i]);
      if (found == header.end() && i + optional < N)
      {
        missing.push_back("'" + names[i] + "'");
      }
      if (std::count(found, header.end(), names[i]) > 1)
      {
        throw InputError(place() + ": column '" + names[i] + "' occurs twice");
      }
      places_[i] = static_cast<std::size_t>(found - header.begin());
    }
    if (!missing.empty())
    {
      throw InputError(place() + ": " + missingText(missing));
    }
  }

  bool hasColumn(std::size_t column) const { return places_[column] < rows_.header().size(); }

  /// Reads the next row, in the order of the names. The value of a missing column is not changed. @returns false at the
  /// end. @throws InputError with line and column.
  bool read(std::array<double, N>& row)
  {
    if (!rows_.next())
    {
      return false;
    }
    for (std::size_t i = 0; i < N; ++i)
    {
      if (hasColumn(i))
      {
        row[i] = number(i, rows_.text(places_[i]));
      }
    }
    return true;
  }

  /// Checks a value of the last row. @throws InputError with line, column, value, unit and range.
  void requireRange(std::size_t column, double value, const Range& range, const std::string& unit) const
  {
    if (!isWithin(value, range))
    {
      throw InputError(outOfRangeText(place() + ": column '" + names_[column] + "'", value, unit, range));
    }
  }

  std::string place() const { return rows_.place(); }

  void allowCutOff() { rows_.allowCutOff(); }
  void allowUneven() { rows_.allowUneven(); }
  bool wasCutOff() const { return rows_.wasCutOff(); }
  std::string unevenText() const { return rows_.unevenText(); }

private:
  std::string missingText(const std::vector<std::string>& missing) const
  {
    const std::vector<std::string>& header = rows_.header();
    const std::string columns = (missing.size() == 1 ? "column " : "columns ") + joined(missing) +
                                (missing.size() == 1 ? " is missing" : " are missing");
    if (std::all_of(header.begin(), header.end(),
                    [](const std::string& text) { return decimalNumber(text).has_value(); }))
    {
      return columns + ": the first line contains numbers, but must be a header with the names of the columns";
    }
    constexpr std::size_t SHOWN = 8;
    std::vector<std::string> first(header.begin(), header.begin() + std::min(header.size(), SHOWN));
    return columns + "; the header has " + std::to_string(header.size()) +
           (header.size() == 1 ? " column" : " columns") + ", separated by " + rows_.separatorName() + ": " +
           joined(first) + (header.size() > SHOWN ? ", ..." : "");
  }

  double number(std::size_t column, const char* text) const
  {
    const std::optional<double> value = decimalNumber(text);
    const bool is_number = value && std::isfinite(*value);
    if (is_number || column >= strict_)
    {
      return is_number ? *value : std::numeric_limits<double>::quiet_NaN();
    }
    if (*text == '\0')
    {
      throw InputError(place() + ": column '" + names_[column] + "' is empty");
    }
    throw InputError(place() + ": column '" + names_[column] + "': '" + text + "' is not a finite number");
  }

  Names names_;
  std::size_t strict_;  // number of columns that must hold finite numbers
  CsvRows rows_;
  // Place of each column in the header; size of the header if the column is missing.
  std::array<std::size_t, N> places_{};
};
}  // namespace hjt
