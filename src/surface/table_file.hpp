// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "solver/response_surface.hpp"
#include "solver/surface_tables.hpp"

namespace hjt
{
/// Checksum of a table's file, which finds damage as textHash does. It processes words in independent rows, because a
/// file of 30 MB is read at every start.
std::uint64_t tableChecksum(std::string_view bytes);

/// Reads a table from its file: the header, the numbers in the machine's format, and the checksum of both. The nodes
/// stay in the file. The length of `header` is a multiple of the size of a number. @returns false if the file is not
/// this user's own, has another header, or is damaged.
bool readTable(const std::string& path, const std::string& header, SurfaceTable& table);
bool readTable(const std::string& path, const std::string& header, DeviationTable& table);
bool readTable(const std::string& path, const std::string& header, BallTable& table);

/// Writes the table. @returns the reason of a failure; empty on success.
std::string writeTable(const std::string& path, const std::string& header, const SurfaceTable& table);
std::string writeTable(const std::string& path, const std::string& header, const DeviationTable& table);
std::string writeTable(const std::string& path, const std::string& header, const BallTable& table);
}  // namespace hjt
