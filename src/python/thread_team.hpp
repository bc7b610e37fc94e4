// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace hjt
{
/// Threads that stay between the pieces of work that they share, and sleep then.
class ThreadTeam
{
public:
  using Task = std::function<void(std::size_t)>;

  /// `threads`: the caller's among them; fewer where the system gives no more.
  explicit ThreadTeam(std::size_t threads);
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;
  ~ThreadTeam();

  std::size_t size() const noexcept { return others_.size() + 1; }

  /// Calls `task`, which must not throw, with each of 0 ... count - 1, in no fixed order, and returns when all are
  /// done; a thread takes `portion` of them at once. From one thread at a time. Does not wait for threads that have not
  /// woken up when all is taken; so it also works in a forked process, where the caller is alone.
  void run(std::size_t count, std::size_t portion, const Task& task);

private:
  struct Work;

  std::shared_ptr<Work> work_;
  std::vector<std::thread> others_;
  long process_;  // that has the threads
};
}  // namespace hjt
