// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hjt
{
/// Joins `text(item)` of all items, with `separator` between two.
template <class Items, class Text>
std::string joined(const Items& items, const char* separator, const Text& text)
{
  std::string all;
  const char* before = "";
  for (const auto& item : items)
  {
    all.append(before).append(text(item));
    before = separator;
  }
  return all;
}

/// Texts, `separator` between two.
template <class Texts>
std::string joined(const Texts& texts, const char* separator = ", ")
{
  return joined(texts, separator, [](const std::string& text) { return text; });
}
}  // namespace hjt
