// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

namespace hjt
{
/// Fowler, Noll, Vo, 1a, 64 bits: distinguishes texts, without protection against deliberate collisions.
/// `hash`: of the text before, to go on from.
constexpr std::uint64_t textHash(std::string_view text, std::uint64_t hash = 14695981039346656037ull)
{
  for (const char c : text)
  {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  }
  return hash;
}

/// Hashes of the source code, the compiler and its options, made by the build (cmake/source_hash.cmake): what is kept
/// in files for other builds names the code it came from.
const char* surfaceSourceHash();  ///< of all that the tables of a response surface come from
const char* sourceHash();         ///< of all of src, include and msg
}  // namespace hjt
