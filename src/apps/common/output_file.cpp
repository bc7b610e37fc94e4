// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
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
    throw InputError(path + " is the input itself; give another name");
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

CsvWriter::CsvWriter(const std::string& path, const std::vector<std::string>& columns)
  : path_(path), file_(std::fopen(path.c_str(), "w"), &std::fclose)
{
  if (!file_)
  {
    fail();
  }
  const char* separator = "";
  for (const std::string& column : columns)
  {
    std::fprintf(file_.get(), "%s%s", separator, column.c_str());
    separator = ",";
  }
  std::fprintf(file_.get(), "\n");
}

void CsvWriter::writeRow(const std::vector<double>& values)
{
  texts_.resize(values.size());
  line_.clear();
  for (std::size_t column = 0; column < values.size(); ++column)
  {
    Text& text = texts_[column];
    // The shortest text that reads back as the same number. Many a column's is that of the row before.
    if (text.size == 0 || std::memcmp(&text.value, &values[column], sizeof(double)) != 0)
    {
      text.value = values[column];
      text.size = static_cast<std::size_t>(fmt::format_to(text.digits.data(), "{},", text.value) - text.digits.data());
    }
    line_.insert(line_.end(), text.digits.data(), text.digits.data() + text.size);
  }
  line_.back() = '\n';
  std::fwrite(line_.data(), 1, line_.size(), file_.get());
}

void CsvWriter::close()
{
  if (std::ferror(file_.get()) != 0 || std::fclose(file_.release()) != 0)
  {
    fail();
  }
}

void CsvWriter::fail() const
{
  throw InputError(path_ + " cannot be written: " + std::strerror(errno));
}
}  // namespace hjt
