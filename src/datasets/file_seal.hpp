// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hjt
{
/// Key for the file's hash in the record of a run: FNV-1a, 64 bits, as 16 hexadecimal digits. For the computation,
/// these digits are zeros. The hash shows damage of the file without another file.
constexpr const char* FILE_HASH = "file_hash";
constexpr const char* OPEN_SEAL = "0000000000000000";

/// Writes the hash into a file whose record, in JSON, contains the seal without its digits. @throws InputError.
void sealFile(const std::string& path);

/// Whether the hash in the file's seal is that of the file.
bool isSealed(const std::string& path);
}  // namespace hjt
