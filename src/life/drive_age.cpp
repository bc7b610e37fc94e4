// SPDX-License-Identifier: BSD-3-Clause
#include "life/drive_age.hpp"

namespace hjt
{
const char* nameOf(const std::optional<EndOfLife>& end) noexcept
{
  if (!end)
  {
    return "still in use";
  }
  switch (*end)
  {
    case EndOfLife::FLANK_WEAR:
      return "flank wear";
    case EndOfLife::INTERFACE_WEAR:
      return "interface wear";
    case EndOfLife::ROOT_CRACK:
      return "root crack";
    case EndOfLife::BEARING:
      return "bearing";
  }
  return "";
}
}  // namespace hjt
