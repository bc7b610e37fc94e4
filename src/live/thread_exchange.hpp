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

/// Ring of ready-made messages between one writer and one reader; neither ever waits.
/// Slots are filled and read in place: messages with arrays are never copied, moved or resized.
template <class Message>
class SlotRing
{
public:
  SlotRing(std::size_t slots, const Message& prototype) : slots_(slots, prototype) {}

  /// Writer: the next free slot, or nullptr if the reader has fallen behind by the whole ring.
  Message* claim() noexcept
  {
    const std::size_t written = written_.load(std::memory_order_relaxed);
    const bool full = written - read_.load(std::memory_order_acquire) == slots_.size();
    return full ? nullptr : &slots_[written % slots_.size()];
  }

  /// Writer: hands over the claimed slot.
  void commit() noexcept { written_.fetch_add(1, std::memory_order_release); }

  /// Reader: the oldest message, or nullptr if there is none.
  const Message* front() const noexcept
  {
    const std::size_t read = read_.load(std::memory_order_relaxed);
    return read == written_.load(std::memory_order_acquire) ? nullptr : &slots_[read % slots_.size()];
  }

  /// Reader: gives the slot of `front` back.
  void pop() noexcept { read_.fetch_add(1, std::memory_order_release); }

private:
  std::vector<Message> slots_;
  std::atomic<std::size_t> written_{ 0 };
  std::atomic<std::size_t> read_{ 0 };
};
}  // namespace hjt
