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
/// @throws InputError if `path` is the input file, or exists and `force` is not given. An empty path, of an option that
/// was
/// not given, is accepted.
void requireWritable(const std::string& path, bool force, const std::string& input = "");

/// Makes the directory of a report, for the file `data` and a page. @throws InputError if it cannot be made, or
/// contains files and `force` is not given.
void prepareReport(const std::string& folder, const std::string& data, bool force);

/// Flushes standard output. @throws InputError if not everything could be written.
void finishStandardOutput();

/// Writes a CSV file of numbers that read back exactly. The file is named `PATH.NUMBER.part` until `close` renames it;
/// without `close` the rows stay there. A device, a pipe and standard output are written directly.
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
  /// @throws InputError with the reason in errno if something was not written.
  void require(bool written) const;

  /// Last text of a column's number, with the separator after it.
  struct Text
  {
    double value;
    std::array<char, 32> digits;  // at most 24 digits, and the separator
    std::size_t size{};           // zero: no text yet
  };

  const std::string path_;
  std::string target_;   // target after resolving links
  std::string written_;  // path of the file that is written
  bool has_rows_{};
  std::vector<Text> texts_;
  std::vector<char> line_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};
}  // namespace hjt
