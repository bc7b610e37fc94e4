// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "solver/response_surface.hpp"
#include "solver/surface_tables.hpp"

namespace hjt
{
/// Checksum of a table's file, which finds damage as surely as textHash does. The checksum is fast, because it
/// processes words in independent rows. Speed matters, because the twin reads a file of 30 MB at each start.
std::uint64_t tableChecksum(std::string_view bytes);

/// Reads a table from its file, which holds the header, the numbers in the machine's format, and the checksum of header
/// and numbers. The nodes stay in the memory of the file. The length of `header` must be a multiple of the size of a
/// number. @returns false if the file does not belong to this user, has another header, or is damaged.
bool readTable(const std::string& path, const std::string& header, SurfaceTable& table);
bool readTable(const std::string& path, const std::string& header, DeviationTable& table);
bool readTable(const std::string& path, const std::string& header, BallTable& table);

/// Writes a table to its file. @returns the reason of a failure; empty on success.
std::string writeTable(const std::string& path, const std::string& header, const SurfaceTable& table);
std::string writeTable(const std::string& path, const std::string& header, const DeviationTable& table);
std::string writeTable(const std::string& path, const std::string& header, const BallTable& table);
}  // namespace hjt
