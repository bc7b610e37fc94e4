// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace hjt
{
/// Number of processors of this machine, at least 1.
unsigned processors() noexcept;

/// Calls `task` with each of 0 ... count - 1 on `threads` threads, the caller's included. The order is not fixed, so
/// the results of a task must not depend on earlier tasks. The caller's thread calls `finished` after each of its tasks
/// with the number of tasks that all threads have finished, and at the end with `count`.
///
/// An exception of a task or of `finished` ends the other tasks and is thrown again.
void runTasks(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task,
              const std::function<void(std::size_t)>& finished);
}  // namespace hjt
