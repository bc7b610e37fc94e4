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
/// Rows of a table in a text file with a header. Commas, semicolons, tabs or blanks separate its texts; the header
/// tells which. Blanks and quotes around a text, a byte order mark and a carriage return before a line's end are not
/// part of it, nor is a # before the header. Between other separators, and in quotes, a comma is a decimal one. Empty
/// lines and lines that begin with # are skipped, and so are empty texts beyond the header's.
class CsvRows
{
public:
  /// Reads the header. @throws InputError on an unreadable or empty file.
  explicit CsvRows(const std::string& path);

  const std::vector<std::string>& header() const { return header_; }

  /// Reads the next row; false at the end. @throws InputError naming the line if it differs in columns from the header.
  bool next();

  /// From now on a last line with too few columns is the end: its writer was stopped in it.
  void allowCutOff() { allows_cut_off_ = true; }
  /// Such a line was left out.
  bool wasCutOff() const { return was_cut_off_; }

  /// From now on any other line with too few or too many columns is a row of empty texts.
  void allowUneven() { allows_uneven_ = true; }
  /// How many columns the last such line and the header have, as a clause; empty: there was none.
  std::string unevenText() const;

  /// "commas", "blanks".
  const char* separatorName() const;

  /// Of the row read last; valid until the next is.
  const char* text(std::size_t column) const { return texts_[column]; }
  /// The number that the text is. @throws InputError naming the line if it is no finite number.
  double number(std::size_t column) const;

  /// File and line of the row read last.
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
  std::size_t length_ = 0;  // of the line
  std::size_t line_number_ = 0;
  char line_end_ = '\n';
  char separator_ = ',';
  bool allows_cut_off_ = false;
  bool allows_uneven_ = false;
  bool was_cut_off_ = false;
  std::size_t uneven_columns_ = 0;  // of the last line that is allowed for it
  std::vector<std::string> header_;
  std::vector<const char*> texts_;
};

/// N named columns of finite numbers in a table with a header; other columns are skipped. Of the last `lenient`
/// columns texts that are no finite number are NaN.
template <std::size_t N>
class NumberTable
{
public:
  using Names = std::array<std::string, N>;

  /// A header with other names for the same columns.
  using Translate = std::vector<std::string> (*)(std::vector<std::string> header);

  /// The last `optional` columns may be missing. @throws InputError on an unreadable file or a wrong header: it names
  /// all columns that are missing.
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
        throw InputError(place() + ": column '" + names[i] + "' is there twice");
      }
      places_[i] = static_cast<std::size_t>(found - header.begin());
    }
    if (!missing.empty())
    {
      throw InputError(place() + ": " + missingText(missing));
    }
  }

  bool hasColumn(std::size_t column) const { return places_[column] < rows_.header().size(); }

  /// The next row, in the order of the names; a missing column keeps its value. False at the end.
  /// @throws InputError naming line and column.
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

  /// @throws InputError naming line, column, value, unit and range.
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
      return columns + ": the first line holds numbers; it has to be the header, with the names of the columns";
    }
    constexpr std::size_t SHOWN = 8;
    std::vector<std::string> first(header.begin(), header.begin() + std::min(header.size(), SHOWN));
    return columns + "; between " + rows_.separatorName() + " the header has " + std::to_string(header.size()) +
           (header.size() == 1 ? " column: " : " columns: ") + joined(first) + (header.size() > SHOWN ? ", ..." : "");
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
  std::size_t strict_;  // columns
  CsvRows rows_;
  std::array<std::size_t, N> places_{};  // in the header; its size if not there
};
}  // namespace hjt
