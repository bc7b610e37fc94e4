// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "harmonic_joint_twin/twin/input_queue.hpp"

namespace hjt
{
/// An input of a loop, which may advance several twins.
struct LiveInput : Input
{
  std::size_t joint{};  ///< whose input it is; 0 where there is one twin
};

/// Hands inputs from the callbacks to the loop. Callbacks may wait for each other; the loop never waits.
class Inbox
{
public:
  static constexpr std::size_t CAPACITY = InputQueue::CAPACITY;

  Inbox() : inputs_(makeBuffer()) {}

  /// From any thread. Values that are not finite are refused, those beyond the capacity dropped; both are counted.
  void push(const Input& input, std::size_t joint = 0)
  {
    if (!std::isfinite(input.value))
    {
      ++not_finite_;
      return;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    if (inputs_.size() == CAPACITY)
    {
      ++overflow_;
      return;
    }
    inputs_.push_back({ input, joint });
  }

  /// From the loop only: appends what has arrived, in order of arrival, to `inputs`, a vector made by `makeBuffer`.
  /// Inputs without room there stay here. While a callback holds the lock, nothing is taken; the next call gets all.
  /// Allocates nothing.
  void take(std::vector<LiveInput>& inputs) noexcept
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock() || inputs_.empty())
    {
      return;
    }
    const auto taken =
        inputs_.begin() + static_cast<std::ptrdiff_t>(std::min(inputs_.size(), CAPACITY - inputs.size()));
    inputs.insert(inputs.end(), inputs_.begin(), taken);
    inputs_.erase(inputs_.begin(), taken);
  }

  /// An empty vector with room for a whole inbox.
  static std::vector<LiveInput> makeBuffer()
  {
    std::vector<LiveInput> buffer;
    buffer.reserve(CAPACITY);
    return buffer;
  }

  std::uint64_t notFinite() const noexcept { return not_finite_; }
  std::uint64_t overflow() const noexcept { return overflow_; }

private:
  std::mutex mutex_;
  std::vector<LiveInput> inputs_;
  std::atomic<std::uint64_t> not_finite_{ 0 };
  std::atomic<std::uint64_t> overflow_{ 0 };
};
}  // namespace hjt
