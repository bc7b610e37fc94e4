// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace hjt
{
/// Number of processors of this machine, at least 1.
unsigned processors() noexcept;

/// Calls `task` with each number of 0 ... count - 1 on `threads` threads, one of which is the caller's thread. The
/// order is not fixed, so the results of a task must not depend on earlier tasks. The caller's thread calls `finished`
/// after each of its tasks with the number of tasks that all threads have finished, and at the end with `count`.
///
/// After an exception of a task or of `finished` no further task begins, and the exception is thrown again.
void runTasks(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task,
              const std::function<void(std::size_t)>& finished);
}  // namespace hjt
