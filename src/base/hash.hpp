// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

namespace hjt
{
/// FNV-1a hash with 64 bits. It distinguishes texts, but does not protect against deliberate collisions. `hash`
/// continues from the hash of a preceding text.
constexpr std::uint64_t textHash(std::string_view text, std::uint64_t hash = 14695981039346656037ull)
{
  for (const char c : text)
  {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  }
  return hash;
}

/// Hashes of the source code, the compiler and its options, which the build computes (cmake/source_hash.cmake). Stored
/// files contain the hash of the code that made them.
const char* surfaceSourceHash();  ///< hash of the code that computes response surfaces
const char* sourceHash();         ///< hash of all files in src, include and msg
}  // namespace hjt
