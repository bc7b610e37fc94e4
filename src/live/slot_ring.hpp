// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace hjt
{
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
