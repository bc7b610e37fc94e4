// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <utility>

namespace hjt
{
/// The newest of some values from callbacks to a loop, which never waits and frees nothing.
template <class Value>
class Handover
{
public:
  explicit Handover(Value unused) : value_(std::move(unused)) {}

  /// From any thread, in place of one that was not taken.
  void give(Value value)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    value_ = std::move(value);
    is_new_ = true;
  }

  /// From the loop: calls `use(Value&)` if there is a new one. What is in the value then is freed by the next `give`.
  template <class Use>
  void take(Use&& use) noexcept
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (lock.owns_lock() && is_new_)
    {
      use(value_);
      is_new_ = false;
    }
  }

private:
  std::mutex mutex_;
  Value value_;
  bool is_new_{};
};
}  // namespace hjt
