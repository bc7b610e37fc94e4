// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "solver/response_surface.hpp"
#include "solver/surface_tables.hpp"

namespace hjt
{
/// Of a file of a table: finds damage, as textHash does, a word at a time in rows that do not wait for each other. A
/// file of 30 MB is read at every start.
std::uint64_t tableChecksum(std::string_view bytes);

/// A table from its file: the header, the numbers as they lie in memory, and the checksum of both. The nodes stay in
/// the file. `header`: its length is a multiple of the size of a number. False if the file is not this
/// user's own, begins otherwise, or is damaged.
bool readTable(const std::string& path, const std::string& header, SurfaceTable& table);
bool readTable(const std::string& path, const std::string& header, DeviationTable& table);
bool readTable(const std::string& path, const std::string& header, BallTable& table);

/// @returns what went wrong; empty: nothing.
std::string writeTable(const std::string& path, const std::string& header, const SurfaceTable& table);
std::string writeTable(const std::string& path, const std::string& header, const DeviationTable& table);
std::string writeTable(const std::string& path, const std::string& header, const BallTable& table);
}  // namespace hjt
