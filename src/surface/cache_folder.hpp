// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace hjt
{
/// Makes a folder for tables, unless it is there. @returns why it is not used, as a sentence; empty: it is. It must be
/// the user's own, and not everybody may write to it.
std::string makeCacheFolder(const std::string& directory);

/// All tables of a folder together have no more, unless one alone has [bytes]: $HJT_CACHE_LIMIT, or 4 GB.
/// @throws ParameterError.
std::uintmax_t cacheLimit();

/// Removes the tables (surface_*.bin, deviations_*.bin, balls_*.bin) that have not been used for longest until all
/// together have no more than `most` bytes, but never `kept`; and temporary files that a writer left more than an hour
/// ago. Twins that use a removed table keep it. @returns what it removed, as a sentence; empty: nothing.
std::string tidyCache(const std::string& directory, const std::string& kept, std::uintmax_t most);
}  // namespace hjt
