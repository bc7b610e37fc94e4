// SPDX-License-Identifier: BSD-3-Clause
#include "base/csv_table.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
constexpr std::size_t LONGEST_LINE = 1 << 20;
constexpr char BYTE_ORDER_MARK[] = "\xEF\xBB\xBF";

bool isBlank(char c)
{
  return c == ' ' || c == '\t';
}

/// Removes blanks, then quotes, from both ends of the text. Writes a zero after the end of the text.
char* trimmed(char* begin, char* end)
{
  begin = std::find_if_not(begin, end, isBlank);
  while (end != begin && isBlank(end[-1]))
  {
    --end;
  }
  if (end - begin > 1 && (*begin == '"' || *begin == '\'') && end[-1] == *begin)
  {
    ++begin;
    --end;
  }
  *end = '\0';
  return begin;
}

/// Name of a column, without a unit in brackets at the end of the name.
std::string withoutUnit(const std::string& name)
{
  static const std::set<std::string> UNITS{ "s", "rad", "rad/s", "A", "N.m", "Nm", "N*m", "degC", "C" };
  const std::size_t open = name.find_last_of("[(");
  if (open == std::string::npos || open == 0 || (name.back() != ']' && name.back() != ')') ||
      UNITS.count(name.substr(open + 1, name.size() - open - 2)) == 0)
  {
    return name;
  }
  const std::size_t last = name.find_last_not_of(" \t_", open - 1);
  return last == std::string::npos ? name : name.substr(0, last + 1);
}

/// End of the quoted text with which the text begins; `begin` if the text does not begin with quotes.
char* endOfQuotes(char* begin, char* end)
{
  char* const first = std::find_if_not(begin, end, isBlank);
  if (first == end || *first != '"')
  {
    return begin;
  }
  char* const last = std::find(first + 1, end, '"');
  return last == end ? begin : last + 1;
}
}  // namespace

CsvRows::CsvRows(const std::string& path) : path_(path), file_(path, std::ios::binary), line_(LONGEST_LINE + 1)
{
  if (!file_.is_open())
  {
    throw InputError(path_ + " cannot be read: " + std::strerror(errno));
  }
  findLineEnd();
  readHeader();
}

/// Finds how lines end. If a carriage return without a line feed comes first, lines end with a carriage return.
void CsvRows::findLineEnd()
{
  if (file_.tellg() == std::ifstream::pos_type(-1))
  {
    return;  // no look ahead in a pipe, which can be read only once
  }
  file_.read(line_.data(), static_cast<std::streamsize>(line_.size()));
  const auto end = line_.cbegin() + file_.gcount();
  const auto first = std::find_if(line_.cbegin(), end, [](char c) { return c == '\r' || c == '\n'; });
  line_end_ = first != end && *first == '\r' && first + 1 != end && first[1] != '\n' ? '\r' : '\n';
  file_.clear();
  file_.seekg(0);
}

/// Finds the header. A line that begins with # is the header if the next line has as many columns. With one column, the
/// next line must also be a number. Otherwise the line with # is a comment.
void CsvRows::readHeader()
{
  bool is_header = false;
  while (!is_header)
  {
    header_.clear();
    if (!readLine())
    {
      throw InputError(path_ + ":1: the header is missing");
    }
    header_.assign(texts_.begin(), texts_.end());
    is_header = header_.front().empty() || header_.front().front() != '#';
    if (is_header)
    {
      continue;
    }
    header_.front().erase(0, header_.front().find_first_not_of("# \t"));
    if (header_.front().empty() && header_.size() > 1)
    {
      header_.erase(header_.begin());
    }
    const auto place = file_.tellg();
    const std::size_t line_number = line_number_;
    is_header = !readLine() || (texts_.size() == header_.size() && texts_.front()[0] != '#' &&
                                (header_.size() > 1 || decimalNumber(texts_.front()).has_value()));
    if (place != std::ifstream::pos_type(-1))  // not at the end of the file
    {
      file_.clear();
      file_.seekg(place);
      line_number_ = line_number;
    }
  }
  std::transform(header_.begin(), header_.end(), header_.begin(), withoutUnit);
}

double CsvRows::number(std::size_t column) const
{
  const std::optional<double> value = decimalNumber(text(column));
  if (!value || !std::isfinite(*value))
  {
    throw InputError(place() + ": column '" + header_[column] + "' is not a finite number");
  }
  return *value;
}

bool CsvRows::next()
{
  do
  {
    if (!readLine())
    {
      return false;
    }
  } while (texts_.front()[0] == '#');
  while (texts_.size() > header_.size() && *texts_.back() == '\0')
  {
    texts_.pop_back();
  }
  if (texts_.size() != header_.size())
  {
    was_cut_off_ =
        allows_cut_off_ && texts_.size() < header_.size() && file_.peek() == std::ifstream::traits_type::eof();
    if (was_cut_off_)
    {
      return false;
    }
    if (!allows_uneven_)
    {
      throw InputError(place() + (texts_.size() < header_.size() ? ": too few columns" : ": too many columns"));
    }
    uneven_columns_ = texts_.size();
    texts_.assign(header_.size(), "");
  }
  return true;
}

std::string CsvRows::unevenText() const
{
  return uneven_columns_ == 0 ? "" :
                                "the header has " + std::to_string(header_.size()) + " columns, separated by " +
                                    separatorName() + ", but a row has " + std::to_string(uneven_columns_);
}

const char* CsvRows::separatorName() const
{
  switch (separator_)
  {
    case ';':
      return "semicolons";
    case '\t':
      return "tabs";
    case ' ':
      return "blanks";
    default:
      return "commas";
  }
}

bool CsvRows::readLine()
{
  const auto is_line_end = [](char c) { return isBlank(c) || c == '\r'; };
  do
  {
    file_.getline(line_.data(), static_cast<std::streamsize>(line_.size()), line_end_);
    if (file_.bad())
    {
      throw InputError(path_ + " cannot be read: " + std::strerror(errno));
    }
    const std::size_t taken = static_cast<std::size_t>(file_.gcount());
    if (taken == 0 && file_.eof())
    {
      return false;
    }
    ++line_number_;
    if (file_.fail())
    {
      throw InputError(place() + ": a line of more than " + std::to_string(LONGEST_LINE) + " characters");
    }
    length_ = file_.eof() ? taken : taken - 1;
    if (std::memchr(line_.data(), '\0', length_) != nullptr)
    {
      throw InputError(place() + ": the file contains a zero byte and is therefore not a text");
    }
  } while (std::all_of(line_.data(), line_.data() + length_, is_line_end));
  split();
  return true;
}

/// Finds the separator of the columns: the first of comma, semicolon, tab and blank that occurs in the header.
void CsvRows::findSeparator()
{
  const auto stands = [this](char c)
  { return std::find(line_.data(), line_.data() + length_, c) != line_.data() + length_; };
  for (const char c : { ',', ';', '\t', ' ' })
  {
    if (stands(c))
    {
      separator_ = c;
      return;
    }
  }
}

void CsvRows::split()
{
  char* begin = line_.data();
  char* end = begin + length_;
  const std::size_t mark = std::strlen(BYTE_ORDER_MARK);
  if (line_number_ == 1 && std::strncmp(begin, BYTE_ORDER_MARK, mark) == 0)
  {
    begin += mark;
  }
  if (end != begin && end[-1] == '\r')
  {
    --end;
  }
  if (header_.empty())
  {
    findSeparator();
  }
  texts_.clear();
  if (separator_ != ',' && !header_.empty())
  {
    std::replace(begin, end, ',', '.');
  }
  if (separator_ == ' ')
  {
    splitAtBlanks(begin, end);
    return;
  }
  for (char* comma = nullptr; comma != end; begin = comma + 1)
  {
    char* const quote_end = header_.empty() ? begin : endOfQuotes(begin, end);
    std::replace(begin, quote_end, ',', '.');
    comma = std::find(quote_end, end, separator_);
    texts_.push_back(trimmed(begin, comma));
  }
}

void CsvRows::splitAtBlanks(char* begin, char* end)
{
  while ((begin = std::find_if_not(begin, end, isBlank)) != end)
  {
    char* blank = std::find_if(begin, end, isBlank);
    const bool is_last = blank == end;
    texts_.push_back(trimmed(begin, blank));
    begin = is_last ? end : blank + 1;
  }
}
}  // namespace hjt
