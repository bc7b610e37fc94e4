// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace hjt
{
/// Sends what a loop has filled: serialising and sending allocate and lock, so they have a thread of their own.
class PublisherThread
{
public:
  /// `drain`: sends all that waits, called from the thread; `is_heard`: whether anybody listens.
  PublisherThread(std::function<void()> drain, std::function<bool()> is_heard);

  /// Stops the thread after what is filled by now.
  ~PublisherThread();

  /// Loop: has what is filled sent. No allocation, no lock that anybody holds for long.
  void wakeUp() noexcept { wake_up_.notify_one(); }

private:
  void run();

  std::function<void()> drain_;
  std::function<bool()> is_heard_;
  std::mutex mutex_;
  std::condition_variable wake_up_;
  bool stopping_{};  // under mutex_
  std::thread thread_;
};
}  // namespace hjt
