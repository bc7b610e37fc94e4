// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace hjt
{
/// Whether the rows of a table stand in the order of the enumeration they are looked up by, none missing. For
/// static_assert.
template <class Rows, class Row, class Key>
constexpr bool isInOrder(const Rows& rows, Key Row::*key)
{
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    if (static_cast<std::size_t>(rows[i].*key) != i)
    {
      return false;
    }
  }
  return true;
}
}  // namespace hjt
