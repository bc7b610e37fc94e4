// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <variant>
#include <vector>

#include "harmonic_joint_twin/twin/input_queue.hpp"

namespace hjt
{
/// An input of a loop, which may advance several twins.
struct LiveInput
{
  TwinInput input;
  std::size_t joint{};  ///< whose input it is; 0 where there is one twin

  Stamp stamp() const noexcept { return stampOf(input); }
  const Input* value() const noexcept { return std::get_if<Input>(&input); }  ///< null: it is a fault
  bool isOf(InputKind kind) const noexcept { return value() != nullptr && value()->kind == kind; }
};

/// Inputs from the callbacks until the loop hands them to its twin. Callbacks may wait for each other and for the loop,
/// which never waits.
class Inbox
{
public:
  static constexpr std::size_t CAPACITY = InputQueue::CAPACITY;

  Inbox() { inputs_.reserve(CAPACITY); }

  /// From any thread. Values that are not finite are refused, those beyond the capacity dropped; both are counted.
  void push(const TwinInput& input, std::size_t joint = 0)
  {
    if (const auto* value = std::get_if<Input>(&input); value != nullptr && !std::isfinite(value->value))
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

  /// From the loop only: calls `use(inputs)` with those that wait, in order of arrival; what it leaves there goes on
  /// waiting. Allocates nothing. @returns false if a callback holds the lock: nothing was done.
  template <class Use>
  bool use(Use&& use) noexcept
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (lock.owns_lock())
    {
      use(inputs_);
    }
    return lock.owns_lock();
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
