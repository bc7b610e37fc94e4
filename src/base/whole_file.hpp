// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hjt
{
/// A text file, whole or not at all, brought to the disk; a device or pipe is written to. @throws InputError.
void writeTextFile(const std::string& path, const std::string& text);

/// Brings a written file to the disk and gives it its name. @throws InputError.
void bringToDisk(const std::string& temporary, const std::string& path);
}  // namespace hjt
