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
/// @throws InputError if `path` exists and `force` is not given, or is the file that is read from. An empty one, of an
/// option that was left out, is none.
void requireWritable(const std::string& path, bool force, const std::string& input = "");

/// Makes the folder of a report, which has the file `data` and a page. @throws InputError if it cannot be made, or
/// holds files and `force` is not given: an earlier report, or somebody's own.
void prepareReport(const std::string& folder, const std::string& data, bool force);

/// Brings what was printed to where it goes. @throws InputError if not all could be written.
void finishStandardOutput();

/// Writes a CSV file of numbers, each of which can be read back exactly. The file is named `PATH.NUMBER.part` until
/// `close` gives it its name; without `close` the rows stay in the `.part`. A device, a pipe and standard output are
/// written directly.
class CsvWriter
{
public:
  /// @throws InputError if the file cannot be written.
  CsvWriter(const std::string& path, const std::vector<std::string>& columns);
  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;
  ~CsvWriter();

  void writeRow(const std::vector<double>& values);

  /// @throws InputError if not all could be written.
  void close();

private:
  /// @throws InputError if something was not written, for the reason in errno.
  void require(bool written) const;

  /// A number as it was last written in a column, with the separator behind it.
  struct Text
  {
    double value;
    std::array<char, 32> digits;  // at most 24, and the separator
    std::size_t size{};           // zero: none yet
  };

  const std::string path_;
  std::string target_;   // behind links
  std::string written_;  // where it is written
  bool has_rows_{};
  std::vector<Text> texts_;
  std::vector<char> line_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};
}  // namespace hjt
