// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace hjt
{
/// All tables of a folder together have no more, unless one alone has [bytes].
constexpr std::uintmax_t MAX_CACHE = std::uintmax_t{ 1 } << 30;

/// Removes the tables (surface_*.bin, deviations_*.bin, balls_*.bin) that have not been used for longest until all
/// together have no more than `most` bytes, but never `kept`; and temporary files that a writer left more than an hour
/// ago. Twins that use a removed table keep it. @returns what it removed, as a sentence; empty: nothing.
std::string tidyCache(const std::string& directory, const std::string& kept, std::uintmax_t most = MAX_CACHE);
}  // namespace hjt
