// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <clocale>

namespace hjt
{
/// While it lives, the C library reads and writes this thread's numbers with a decimal point, whatever locale the program
/// has set. Does not allocate.
class DecimalPoint
{
public:
  DecimalPoint() noexcept : before_(uselocale(plain())) {}
  DecimalPoint(const DecimalPoint&) = delete;
  DecimalPoint& operator=(const DecimalPoint&) = delete;
  ~DecimalPoint() { uselocale(before_); }

private:
  static locale_t plain() noexcept
  {
    static const locale_t PLAIN = newlocale(LC_ALL_MASK, "C", nullptr);  // one that always exists
    return PLAIN;
  }

  locale_t before_;
};
}  // namespace hjt
