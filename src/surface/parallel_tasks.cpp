// SPDX-License-Identifier: BSD-3-Clause
#include "surface/parallel_tasks.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace hjt
{
unsigned processors() noexcept
{
  return std::max(1u, std::thread::hardware_concurrency());
}

void runTasks(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task,
              const std::function<void(std::size_t)>& finished)
{
  std::atomic<std::size_t> next{ 0 };
  std::atomic<std::size_t> done{ 0 };
  std::exception_ptr failure;
  std::mutex mutex;  // protects `failure`
  const auto work = [&](bool reports)
  {
    try
    {
      for (std::size_t i = next++; i < count; i = next++)
      {
        task(i);
        const std::size_t so_far = ++done;
        if (reports && so_far < count)
        {
          finished(so_far);
        }
      }
    }
    catch (...)
    {
      next = count;
      const std::lock_guard<std::mutex> lock(mutex);
      failure = failure ? failure : std::current_exception();
    }
  };
  std::vector<std::thread> others;
  try
  {
    while (others.size() + 1 < std::min<std::size_t>(threads, count))
    {
      others.emplace_back(work, false);
    }
  }
  catch (const std::system_error&)
  {
    // The system allows no more threads. The existing threads do the work.
  }
  work(true);
  for (std::thread& other : others)
  {
    other.join();
  }
  if (failure)
  {
    std::rethrow_exception(failure);
  }
  finished(count);
}
}  // namespace hjt
