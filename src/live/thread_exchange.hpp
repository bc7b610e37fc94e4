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
/// An input of a loop that advances one or more twins.
struct LiveInput
{
  TwinInput input;
  std::size_t joint{};  ///< index of the joint that gets the input; 0 if there is one twin

  Stamp stamp() const noexcept { return stampOf(input); }
  const Input* value() const noexcept { return std::get_if<Input>(&input); }  ///< the input; null for a fault
  bool isOf(InputKind kind) const noexcept { return value() != nullptr && value()->kind == kind; }
};

/// Queue of inputs from callbacks to the loop. A callback may wait for another callback or for the loop. The loop never
/// waits.
class Inbox
{
public:
  static constexpr std::size_t CAPACITY = InputQueue::CAPACITY;

  Inbox() { inputs_.reserve(CAPACITY); }

  /// Queues an input; thread-safe. An input that is not finite is refused, and an input beyond the capacity is dropped.
  /// The queue counts refused and dropped inputs.
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

  /// Calls `use(inputs)` with the waiting inputs in order of arrival, without allocation. Inputs that `use` does not
  /// remove stay in the queue. Only the loop may call this function. If a callback holds the lock, the function does
  /// nothing and returns false.
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

/// Ring buffer of preallocated messages between one writer and one reader, which never wait. A message is filled and
/// read in its slot, so that its arrays are never copied, moved or resized.
template <class Message>
class SlotRing
{
public:
  SlotRing(std::size_t slots, const Message& prototype) : slots_(slots, prototype) {}

  /// For the writer: the next free slot; nullptr if the buffer is full.
  Message* claim() noexcept
  {
    const std::size_t written = written_.load(std::memory_order_relaxed);
    const bool full = written - read_.load(std::memory_order_acquire) == slots_.size();
    return full ? nullptr : &slots_[written % slots_.size()];
  }

  /// For the writer: hands the claimed slot to the reader.
  void commit() noexcept { written_.fetch_add(1, std::memory_order_release); }

  /// For the reader: the oldest message; nullptr if the buffer is empty.
  const Message* front() const noexcept
  {
    const std::size_t read = read_.load(std::memory_order_relaxed);
    return read == written_.load(std::memory_order_acquire) ? nullptr : &slots_[read % slots_.size()];
  }

  /// For the reader: releases the slot of `front`.
  void pop() noexcept { read_.fetch_add(1, std::memory_order_release); }

private:
  std::vector<Message> slots_;
  std::atomic<std::size_t> written_{ 0 };
  std::atomic<std::size_t> read_{ 0 };
};
}  // namespace hjt
