// SPDX-License-Identifier: BSD-3-Clause
#include "base/csv_rows.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

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

/// The text between the two without blanks around it, ended by a zero.
const char* trimmed(char* begin, char* end)
{
  begin = std::find_if_not(begin, end, isBlank);
  while (end != begin && isBlank(end[-1]))
  {
    --end;
  }
  *end = '\0';
  return begin;
}
}  // namespace

CsvRows::CsvRows(const std::string& path) : path_(path), file_(path, std::ios::binary), line_(LONGEST_LINE + 1)
{
  if (!file_.is_open())
  {
    throw InputError(path_ + " cannot be read: " + std::strerror(errno));
  }
  if (!readLine())
  {
    throw InputError(path_ + ":1: the header is missing");
  }
  header_.assign(texts_.begin(), texts_.end());
}

bool CsvRows::next()
{
  if (!readLine())
  {
    return false;
  }
  if (texts_.size() != header_.size())
  {
    throw InputError(place() + (texts_.size() < header_.size() ? ": too few columns" : ": too many columns"));
  }
  return true;
}

bool CsvRows::readLine()
{
  file_.getline(line_.data(), static_cast<std::streamsize>(line_.size()));
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
    throw InputError(place() + ": a zero byte, so it is no text");
  }
  split();
  return true;
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
  texts_.clear();
  for (char* comma = nullptr; comma != end; begin = comma + 1)
  {
    comma = std::find(begin, end, ',');
    texts_.push_back(trimmed(begin, comma));
  }
}
}  // namespace hjt
