// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <ctime>
#include <string>

#include "harmonic_joint_twin/base/stamp.hpp"

namespace hjt
{
/// Of a date [ns], in UTC. @param format of strftime, 31 letters at most
inline std::string dateText(Stamp date, const char* format)
{
  constexpr Stamp SECOND = 1'000'000'000;
  const auto seconds = static_cast<std::time_t>(date / SECOND);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  return { text.data(), std::strftime(text.data(), text.size(), format, &parts) };
}
}  // namespace hjt
