// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt::fmu
{
/// Appends a number, no truth value, as this machine has it.
template <class Number>
void putNumber(std::string& bytes, Number number)
{
  static_assert(std::is_arithmetic_v<Number> && !std::is_same_v<Number, bool>);
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

inline void putText(std::string& bytes, std::string_view text)
{
  putNumber(bytes, static_cast<std::uint64_t>(text.size()));
  bytes.append(text);
}

/// Takes from the front what was put. @throws InputError where less is left.
class ByteReader
{
public:
  explicit ByteReader(std::string_view bytes) : left_(bytes) {}

  template <class Number>
  Number number()
  {
    Number found;
    std::memcpy(&found, take(sizeof found).data(), sizeof found);
    return found;
  }
  std::string_view text() { return take(number<std::uint64_t>()); }
  std::string_view rest() const noexcept { return left_; }
  bool empty() const noexcept { return left_.empty(); }

private:
  std::string_view take(std::uint64_t size)
  {
    if (size > left_.size())
    {
      throw InputError("a serialised state ends too early");
    }
    const std::string_view taken = left_.substr(0, size);
    left_.remove_prefix(size);
    return taken;
  }

  std::string_view left_;
};
}  // namespace hjt::fmu
