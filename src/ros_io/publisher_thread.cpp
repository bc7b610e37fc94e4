// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/publisher_thread.hpp"

#include <chrono>
#include <exception>
#include <utility>

#include <ros/console.h>

namespace hjt
{
namespace
{
using std::chrono::milliseconds;

/// How long a message waits at most if the loop's wake-up was missed: it does not wait for the mutex.
constexpr milliseconds DRAIN_PERIOD{ 20 };
/// The same for a change of the faults while there are no subscribers.
constexpr milliseconds IDLE_PERIOD{ 100 };
}  // namespace

PublisherThread::PublisherThread(std::function<void()> drain, std::function<bool()> is_heard)
  : drain_(std::move(drain)), is_heard_(std::move(is_heard)), thread_([this] { run(); })
{
}

PublisherThread::~PublisherThread()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  wake_up_.notify_one();
  thread_.join();
}

void PublisherThread::run()
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
}  // namespace hjt
