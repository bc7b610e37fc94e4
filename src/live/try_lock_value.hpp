// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>

namespace hjt
{
/// A small value the loop shows to other threads. The writer never waits: it skips a write while somebody reads.
template <class Value>
class TryLockValue
{
public:
  void tryWrite(const Value& value) noexcept
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (lock.owns_lock())
    {
      value_ = value;
    }
  }

  Value read() const
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return value_;
  }

private:
  mutable std::mutex mutex_;
  Value value_{};
};
}  // namespace hjt
