// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>

// The files are small; a reading thread is not worth it.
#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
/// N named columns of finite numbers in a CSV file with a header; other columns are skipped. Of the last `lenient`
/// columns texts that are no finite number are NaN.
template <std::size_t N>
class NumberTable
{
public:
  using Names = std::array<std::string, N>;

  /// The last `optional` columns may be missing. @throws InputError on an unreadable file or a wrong header.
  NumberTable(const std::string& path, const Names& names, std::size_t optional = 0, std::size_t lenient = 0)
  try : path_(path), names_(names), strict_(N - lenient), reader_(path)
  {
    readHeader(std::make_index_sequence<N>{});
    for (std::size_t i = 0; i + optional < N; ++i)
    {
      if (!hasColumn(i))
      {
        throw InputError(path + ":1: column '" + names[i] + "' is missing");
      }
    }
  }
  catch (const io::error::can_not_open_file& error)
  {
    throw InputError(path + " cannot be read: " + std::strerror(error.errno_value));
  }
  catch (const io::error::base& error)
  {
    throw InputError(path + ": " + error.what());
  }

  bool hasColumn(std::size_t column) const { return present_[column]; }

  /// The next row, in the order of the names; a missing column keeps its value. False at the end.
  /// @throws InputError naming line and column.
  bool read(std::array<double, N>& row)
  {
    std::array<char*, N> texts{};
    if (!readTexts(texts, std::make_index_sequence<N>{}))
    {
      return false;
    }
    for (std::size_t i = 0; i < N; ++i)
    {
      if (texts[i] != nullptr)
      {
        row[i] = number(i, texts[i]);
      }
    }
    return true;
  }

  /// @throws InputError naming line, column, value, unit and range.
  void requireRange(std::size_t column, double value, const Range& range, const std::string& unit) const
  {
    if (!(value >= range.min && value <= range.max))
    {
      throw InputError(place() + ": column '" + names_[column] + "' = " + numberText(value) + " [" + unit +
                       "] is out of range, allowed: " + rangeText(range) + " [" + unit + "]");
    }
  }

  std::string place() const { return path_ + ":" + std::to_string(reader_.get_file_line()); }

private:
  template <std::size_t... I>
  void readHeader(std::index_sequence<I...>)
  {
    reader_.read_header(io::ignore_extra_column | io::ignore_missing_column, names_[I]...);
    ((present_[I] = reader_.has_column(names_[I])), ...);
  }

  template <std::size_t... I>
  bool readTexts(std::array<char*, N>& texts, std::index_sequence<I...>)
  {
    try
    {
      return reader_.read_row(texts[I]...);
    }
    catch (const io::error::too_few_columns&)
    {
      throw InputError(place() + ": too few columns");
    }
    catch (const io::error::too_many_columns&)
    {
      throw InputError(place() + ": too many columns");
    }
    catch (const io::error::base& error)
    {
      throw InputError(place() + ": " + error.what());
    }
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

  std::string path_;
  Names names_;
  std::size_t strict_;  // columns
  io::CSVReader<N> reader_;
  std::array<bool, N> present_{};
};
}  // namespace hjt
