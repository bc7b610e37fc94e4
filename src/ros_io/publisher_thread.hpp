// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include <ros/console.h>

namespace hjt
{
/// Sends what a loop has filled: serialising and sending allocate and lock, so they have a thread of their own.
class PublisherThread
{
public:
  /// `drain`: sends all that waits, called from the thread; `is_heard`: whether anybody listens.
  PublisherThread(std::function<void()> drain, std::function<bool()> is_heard)
    : drain_(std::move(drain)), is_heard_(std::move(is_heard)), thread_([this] { run(); })
  {
  }

  /// Stops the thread after what is filled by now.
  ~PublisherThread()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    wake_up_.notify_one();
    thread_.join();
  }

  /// Loop: has what is filled sent. No allocation, no lock that anybody holds for long.
  void wakeUp() noexcept { wake_up_.notify_one(); }

private:
  // How long a message waits at most if the loop's wake-up was missed: it does not wait for the mutex.
  static constexpr std::chrono::milliseconds DRAIN_PERIOD{ 20 };
  // The same for a change of the faults while there are no subscribers.
  static constexpr std::chrono::milliseconds IDLE_PERIOD{ 100 };

  void run()
  {
    std::unique_lock<std::mutex> lock(mutex_);
    for (bool stopping = false; !stopping;)
    {
      if (!stopping_)
      {
        wake_up_.wait_for(lock, is_heard_() ? DRAIN_PERIOD : IDLE_PERIOD);
      }
      stopping = stopping_;
      lock.unlock();
      try
      {
        drain_();
      }
      catch (const std::exception& error)  // the thread's border: the next round goes on
      {
        ROS_WARN_STREAM_THROTTLE(60.0, "Messages of the twin are not published: " << error.what());
      }
      lock.lock();
    }
  }

  std::function<void()> drain_;
  std::function<bool()> is_heard_;
  std::mutex mutex_;
  std::condition_variable wake_up_;
  bool stopping_{};  // under mutex_
  std::thread thread_;
};
}  // namespace hjt
