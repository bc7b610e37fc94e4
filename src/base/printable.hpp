// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

namespace hjt
{
/// Text from outside for a line of a log: control characters become '?', what is beyond `longest` bytes "...".
inline std::string printable(std::string text, std::size_t longest = 60)
{
  if (text.size() > longest)
  {
    text.resize(longest);
    text += "...";
  }
  const auto is_control = [](unsigned char character) { return character < ' ' || character == 0x7f; };
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}
}  // namespace hjt
