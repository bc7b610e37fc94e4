// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

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
}  // namespace hjt
