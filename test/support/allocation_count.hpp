// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace hjt
{
/// Heap allocations of the whole process since start, from C++ and C alike: Eigen calls malloc, not operator new.
/// To be linked into the executable, where it takes the place of the C library's functions.
std::size_t allocationCount() noexcept;
}  // namespace hjt
