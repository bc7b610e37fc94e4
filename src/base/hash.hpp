// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

namespace hjt
{
/// FNV-1a hash with 64 bits, which distinguishes texts but does not protect against deliberate collisions. `hash`: hash
/// of a preceding text, to hash both texts as one.
constexpr std::uint64_t textHash(std::string_view text, std::uint64_t hash = 14695981039346656037ull)
{
  for (const char c : text)
  {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  }
  return hash;
}

/// The build computes both hashes from source code, compiler and its options (cmake/source_hash.cmake). A stored file
/// contains the hash of the code that made the file.
const char* surfaceSourceHash();  ///< hash of the code that computes response surfaces
const char* sourceHash();         ///< hash of all files in src, include and msg
}  // namespace hjt
