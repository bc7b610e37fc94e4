// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace hjt
{
/// Checks that the file `path` may be written. @throws InputError if `path` is the file `input`, or if the file exists
/// and `force` is false. An empty path is accepted: the user has not given the option.
void requireWritable(const std::string& path, bool force, const std::string& input = "");

/// Makes the directory of a report, for the file `data` and a page. @throws InputError if the directory cannot be made,
/// or if the directory contains files and `force` is false.
void prepareReport(const std::string& folder, const std::string& data, bool force);

/// Flushes standard output. @throws InputError if not everything could be written.
void finishStandardOutput();

/// Writes a CSV file of numbers that read back exactly. The file has the name `PATH.NUMBER.part` until `close` gives it
/// the name PATH. Without `close` the first name stays. A device, a pipe and standard output are written directly.
class CsvWriter
{
public:
  /// @throws InputError if the file cannot be written.
  CsvWriter(const std::string& path, const std::vector<std::string>& columns);
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;
  ~CsvWriter();

  void writeRow(const std::vector<double>& values);

  /// @throws InputError if not everything could be written.
  void close();

private:
  /// @throws InputError with the reason in errno, if `written` is false.
  void require(bool written) const;

  /// Text of the last number of a column, with the separator after it.
  struct Text
  {
    double value;
    std::array<char, 32> digits;  // at most 24 digits, and the separator
    std::size_t size{};           // length of the text; 0 before the first number
  };

  const std::string path_;
  std::string target_;   // final path, after resolving links
  std::string written_;  // path of the file before `close`
  bool has_rows_{};
  std::vector<Text> texts_;
  std::vector<char> line_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};
}  // namespace hjt
