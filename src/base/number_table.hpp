// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/csv_rows.hpp"
#include "base/joined.hpp"
#include "base/range_check.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
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
