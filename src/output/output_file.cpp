// SPDX-License-Identifier: BSD-3-Clause
#include "output/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>

#include <fmt/compile.h>
#include <fmt/format.h>

#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

// Version 6 of the library fmt cannot compile a format, so the library gets the format as text.
#ifndef FMT_COMPILE
#define FMT_COMPILE(text) text
#endif

namespace hjt
{
namespace
{
constexpr const char* STDOUT = "/dev/stdout";
}  // namespace

void requireWritable(const std::string& path, bool force, const std::string& input)
{
  namespace fs = std::filesystem;
  std::error_code error;
  if (path.empty())
  {
    return;
  }
  if (!input.empty() && fs::equivalent(path, input, error))
  {
    throw InputError(path + " is the input file; give another name for the output");
  }
  if (fs::is_directory(path, error))
  {
    throw InputError(path + " is a directory");
  }
  if (fs::exists(path, error) && !force)
  {
    throw InputError(path + " exists; --force overwrites it");
  }
}

void prepareReport(const std::string& folder, const std::string& data, bool force)
{
  namespace fs = std::filesystem;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
  {
    throw InputError(folder + ": the directory cannot be made: " + error.message());
  }
  requireWritable((fs::path(folder) / data).string(), force);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
  {
    if (!force && !entry.is_directory(error))
    {
      throw InputError(folder + " already contains files, for example " + entry.path().filename().string() +
                       "; give another directory, or --force to overwrite the files of a report");
    }
  }
}

void finishStandardOutput()
{
  errno = 0;
  std::cout.flush();
  if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
  {
    const int reason = errno;
    throw InputError(std::string("standard output cannot be written") +
                     (reason != 0 ? std::string(": ") + std::strerror(reason) : ""));
  }
}

CsvWriter::CsvWriter(const std::string& path, const std::vector<std::string>& columns)
  : path_(path), file_(nullptr, &std::fclose)
{
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);  // after resolving links
  const bool is_stream = fs::exists(status) && (!fs::is_regular_file(status) || fs::equivalent(path, STDOUT, error));
  const fs::path there = fs::canonical(path, error);  // empty if the file does not exist yet
  target_ = is_stream || error ? path : there.string();
  written_ = is_stream ? target_ : makeFileBeside(target_);
  file_.reset(std::fopen(written_.c_str(), "w"));
  require(file_ != nullptr);
  require(std::fputs((joined(columns, ",") + "\n").c_str(), file_.get()) >= 0);
}

CsvWriter::~CsvWriter()
{
  if (!has_rows_ && written_ != target_)
  {
    std::error_code error;
    std::filesystem::remove(written_, error);
  }
}

void CsvWriter::writeRow(const std::vector<double>& values)
{
  texts_.resize(values.size());
  line_.clear();
  for (std::size_t column = 0; column < values.size(); ++column)
  {
    Text& text = texts_[column];
    // Writes the shortest text that reads back as this number. A value equal to that of the row before keeps its text.
    if (text.size == 0 || std::memcmp(&text.value, &values[column], sizeof(double)) != 0)
    {
      text.value = values[column];
      text.size = static_cast<std::size_t>(fmt::format_to(text.digits.data(), FMT_COMPILE("{},"), text.value) -
                                           text.digits.data());
    }
    line_.insert(line_.end(), text.digits.data(), text.digits.data() + text.size);
  }
  line_.back() = '\n';
  require(std::fwrite(line_.data(), 1, line_.size(), file_.get()) == line_.size());
  has_rows_ = true;
}

void CsvWriter::close()
{
  require(std::fclose(file_.release()) == 0);
  if (written_ != target_)
  {
    bringToDisk(written_, target_);
  }
}

void CsvWriter::require(bool written) const
{
  if (!written)
  {
    const int reason = errno;
    const bool is_part = has_rows_ && written_ != target_;
    throw InputError(path_ + " cannot be written: " + std::strerror(reason) +
                     (is_part ? "; " + written_ + " contains the rows before the error" : ""));
  }
}
}  // namespace hjt
