// SPDX-License-Identifier: BSD-3-Clause
#include "python/thread_team.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <system_error>

namespace hjt
{
namespace
{
/// Spins for about as long as it takes to wake a thread.
template <class Condition>
void spin(const Condition& condition)
{
  const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(50);
  while (!condition() && std::chrono::steady_clock::now() < end)
  {
  }
}
}  // namespace

struct ThreadTeam::Work
{
  std::mutex mutex;
  std::condition_variable begun;
  std::condition_variable left;
  const Task* task{};  // null: none that a thread may still join
  std::size_t count{};
  std::size_t portion{};
  std::atomic<std::uint64_t> number{ 0 };
  std::atomic<std::size_t> busy{ 0 };  // of the other threads
  std::atomic<bool> ends{ false };
  std::atomic<std::size_t> next{ 0 };

  void share(const Task& todo)
  {
    for (std::size_t first = next.fetch_add(portion); first < count; first = next.fetch_add(portion))
    {
      for (std::size_t i = first; i < std::min(first + portion, count); ++i)
      {
        todo(i);
      }
    }
  }

  void serve()
  {
    for (std::uint64_t last = 0;;)
    {
      const auto is_called = [&] { return ends || number != last; };
      spin(is_called);
      std::unique_lock<std::mutex> lock(mutex);
      begun.wait(lock, is_called);
      if (ends)
      {
        return;
      }
      last = number;
      const Task* const todo = task;
      if (todo == nullptr)
      {
        continue;  // done without this thread
      }
      ++busy;
      lock.unlock();
      share(*todo);
      lock.lock();
      if (--busy == 0)
      {
        left.notify_one();
      }
    }
  }
};

ThreadTeam::ThreadTeam(std::size_t threads) : work_(std::make_shared<Work>()), process_(::getpid())
{
  try
  {
    while (others_.size() + 1 < threads)
    {
      others_.emplace_back([work = work_] { work->serve(); });
    }
  }
  catch (const std::system_error&)
  {
    // No more threads are to be had: those there are do the work.
  }
}

ThreadTeam::~ThreadTeam()
{
  if (::getpid() != process_)
  {
    // The threads are in the parent process, and what they wait for stays, unused.
    for (std::thread& other : others_)
    {
      other.detach();
    }
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(work_->mutex);
    work_->ends = true;
  }
  work_->begun.notify_all();
  for (std::thread& other : others_)
  {
    other.join();
  }
}

void ThreadTeam::run(std::size_t count, std::size_t portion, const Task& task)
{
  {
    const std::lock_guard<std::mutex> lock(work_->mutex);
    work_->task = &task;
    work_->count = count;
    work_->portion = portion;
    work_->next = 0;
    ++work_->number;
  }
  work_->begun.notify_all();
  work_->share(task);
  {
    const std::lock_guard<std::mutex> lock(work_->mutex);
    work_->task = nullptr;
  }
  const auto all_left = [&] { return work_->busy == 0; };
  spin(all_left);
  std::unique_lock<std::mutex> lock(work_->mutex);
  work_->left.wait(lock, all_left);
}
}  // namespace hjt
