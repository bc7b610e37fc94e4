// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hjt
{
/// Hashes of the source code, the compiler and its options, made by the build (cmake/source_hash.cmake): what is kept
/// in files for other builds names the code it came from.
const char* surfaceSourceHash();  ///< of all that the tables of a response surface come from
const char* sourceHash();         ///< of all of src, include and msg
}  // namespace hjt
