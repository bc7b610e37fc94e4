// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace hjt
{
/// Largest size of a file that is read into memory at once [byte].
inline constexpr std::size_t MAX_TEXT = 10'000'000;
inline constexpr std::size_t MAX_BINARY = 1'000'000'000;

/// Content of a regular file of at most `most` bytes; none if the file is not regular, too large or unreadable. The
/// function does not block on a pipe, a device or an endless file. `reason` gets the reason of a failure.
std::optional<std::string> wholeFile(const std::string& path, std::size_t most = MAX_TEXT,
                                     std::string* reason = nullptr);
/// Content of the file. @throws InputError with the reason if wholeFile fails.
std::string readFile(const std::string& path, std::size_t most = MAX_TEXT);

/// Writes a text file atomically and flushes it to the disk. The function follows links. To a device or a pipe it
/// writes directly. @throws InputError.
void writeTextFile(const std::string& path, const std::string& text);

/// Writes a new file atomically, with access for this user only, and flushes it to the disk. The new file replaces any
/// file of this name. The function follows no link and opens no pipe. @throws InputError.
void writePrivateFile(const std::string& path, const std::string& bytes);

/// Makes a new empty file beside `target`. Its name cannot be predicted, so no existing file or link is opened.
/// @returns the path of the file. @throws InputError.
std::string makeFileBeside(const std::string& target);

/// Flushes a complete file to the disk and renames it to `path`. @throws InputError.
void bringToDisk(const std::string& temporary, const std::string& path);
}  // namespace hjt
