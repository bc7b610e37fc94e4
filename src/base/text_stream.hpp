// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <locale>
#include <sstream>

namespace hjt
{
/// A text to write to. Its numbers have a decimal point and no separators, whatever locale the program has set.
class TextStream : public std::ostringstream
{
public:
  TextStream() { imbue(std::locale::classic()); }
};
}  // namespace hjt
