// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hjt
{
/// Key of a run's record under which its file carries the hash (FNV-1a, 64 bits) of its own bytes, in 16 hexadecimal
/// digits that count as zeros in it: any damage to the file is found without anything beside it.
constexpr const char* FILE_HASH = "file_hash";
constexpr const char* OPEN_SEAL = "0000000000000000";

/// Puts the hash in place of the open seal of a file whose record is in it as JSON. @throws InputError.
void sealFile(const std::string& path);

/// Whether the file has the hash that it carries.
bool isSealed(const std::string& path);
}  // namespace hjt
