// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace hjt
{
/// The bytes of a file; none if it cannot be read.
std::optional<std::string> wholeFile(const std::string& path);
std::string readFile(const std::string& path);  ///< @throws InputError in place of none

/// A text file, whole or not at all, brought to the disk. Links are followed; a device or pipe is written to.
/// @throws InputError.
void writeTextFile(const std::string& path, const std::string& text);

/// A new file that only this user may read and write, whole or not at all, brought to the disk. It takes the place of
/// whatever has the name: a link is not followed, a pipe not opened. @throws InputError.
void writePrivateFile(const std::string& path, const std::string& bytes);

/// Brings a written file to the disk and gives it its name. @throws InputError.
void bringToDisk(const std::string& temporary, const std::string& path);
}  // namespace hjt
