// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>

namespace hjt::fmu
{
/// A ZIP archive whose files are stored as they are (PKWARE's APPNOTE, ISO/IEC 21320-1), each below 4 GB.
class Zip
{
public:
  /// `name`: with / between folders.
  void add(const std::string& name, const std::string& bytes)
  {
    const auto offset = static_cast<std::uint32_t>(files_.size());
    const auto size = static_cast<std::uint32_t>(bytes.size());
    // Version 1.0, no flags, stored; 1980-01-01 00:00.
    std::string common;
    append(common,
           { { 10, 2 }, { 0, 2 }, { 0, 2 }, { 0, 2 }, { 0x21, 2 }, { crc(bytes), 4 }, { size, 4 }, { size, 4 } });
    append(common, { { static_cast<std::uint32_t>(name.size()), 2 }, { 0, 2 } });
    append(files_, { { 0x04034b50, 4 } });
    files_ += common + name + bytes;
    // Made on Unix by version 2.0; a file that all may read, and run.
    append(directory_, { { 0x02014b50, 4 }, { 0x0314, 2 } });
    directory_ += common;
    append(directory_, { { 0, 2 }, { 0, 2 }, { 0, 2 }, { 0100755u << 16, 4 }, { offset, 4 } });
    directory_ += name;
    ++count_;
  }

  std::string bytes() const
  {
    std::string all = files_ + directory_;
    append(all, { { 0x06054b50, 4 },
                  { 0, 2 },
                  { 0, 2 },
                  { count_, 2 },
                  { count_, 2 },
                  { static_cast<std::uint32_t>(directory_.size()), 4 },
                  { static_cast<std::uint32_t>(files_.size()), 4 },
                  { 0, 2 } });
    return all;
  }

private:
  /// Numbers of so many bytes each, the lowest first.
  static void append(std::string& text, std::initializer_list<std::pair<std::uint32_t, int>> numbers)
  {
    for (const auto& [number, bytes] : numbers)
    {
      for (int i = 0; i < bytes; ++i)
      {
        text += static_cast<char>(number >> (8 * i) & 0xff);
      }
    }
  }

  static std::uint32_t crc(const std::string& bytes)
  {
    constexpr std::uint32_t POLYNOMIAL = 0xedb88320;
    std::uint32_t value = 0xffffffff;
    for (const char byte : bytes)
    {
      value ^= static_cast<unsigned char>(byte);
      for (int bit = 0; bit < 8; ++bit)
      {
        value = value >> 1 ^ ((value & 1) != 0 ? POLYNOMIAL : 0);
      }
    }
    return ~value;
  }

  std::string files_;
  std::string directory_;
  std::uint32_t count_{};
};
}  // namespace hjt::fmu
