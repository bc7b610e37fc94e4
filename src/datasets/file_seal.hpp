// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hjt
{
/// Key, in a run's record, of the file's hash (FNV-1a, 64 bits) in 16 hexadecimal digits, which count as zeros. Damage
/// of the file is thus detected without another file.
constexpr const char* FILE_HASH = "file_hash";
constexpr const char* OPEN_SEAL = "0000000000000000";

/// Writes the hash into a file whose record, as JSON, contains the open seal. @throws InputError.
void sealFile(const std::string& path);

/// Whether the file has the hash in its seal.
bool isSealed(const std::string& path);
}  // namespace hjt
