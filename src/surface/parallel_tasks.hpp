// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace hjt
{
/// Processors of this machine, at least 1.
unsigned processors() noexcept;

/// Calls `task` with each of 0 ... count - 1, on as many threads as given, the caller's among them. The order is not
/// fixed, so what a task leaves must not depend on the ones before it. `finished`: called from the caller's thread
/// after each of its tasks with the number that all threads have finished, and once in the end with `count`.
///
/// An exception of a task or of `finished` ends the other tasks and is rethrown.
void runTasks(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task,
              const std::function<void(std::size_t)>& finished);
}  // namespace hjt
