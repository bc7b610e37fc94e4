// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace hjt
{
/// Of a file that is read whole into memory [byte].
inline constexpr std::size_t MAX_TEXT = 10'000'000;
inline constexpr std::size_t MAX_BINARY = 1'000'000'000;

/// The bytes of a regular file of at most `most`; none if it is another, or cannot be read. A pipe, a device or a file
/// without end holds up nobody. `reason`: gets why there are none.
std::optional<std::string> wholeFile(const std::string& path, std::size_t most = MAX_TEXT,
                                     std::string* reason = nullptr);
/// @throws InputError with the reason in place of none.
std::string readFile(const std::string& path, std::size_t most = MAX_TEXT);

/// A text file, whole or not at all, brought to the disk. Links are followed; a device or pipe is written to.
/// @throws InputError.
void writeTextFile(const std::string& path, const std::string& text);

/// A new file that only this user may read and write, whole or not at all, brought to the disk. It takes the place of
/// whatever has the name: a link is not followed, a pipe not opened. @throws InputError.
void writePrivateFile(const std::string& path, const std::string& bytes);

/// A new, empty file beside `target` to write that into, under a name that nobody knows beforehand: what lies there, a
/// link or another's file, is not opened. @returns its path. @throws InputError.
std::string makeFileBeside(const std::string& target);

/// Brings a written file to the disk and gives it its name. @throws InputError.
void bringToDisk(const std::string& temporary, const std::string& path);
}  // namespace hjt
