// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "harmonic_joint_twin/params/faults.hpp"
#include "harmonic_joint_twin/twin/input_queue.hpp"

namespace hjt
{
/// Numbers of injected faults since the last reset.
struct FaultCounters
{
  std::uint64_t accepted{};  ///< faults that the twin queued
  std::uint64_t refused{};   ///< refused faults, whose severity, place or onset is out of range
  std::uint64_t late{};      ///< faults with a stamp before the simulated instant, which set in at once
  std::uint64_t no_room{};   ///< faults that the twin refused because too many faults wait or are active
};

/// Faults that wait, in the order of their stamps and, for equal stamps, of their arrival. The storage has a fixed
/// size.
class FaultSchedule
{
public:
  static constexpr std::size_t CAPACITY = 2 * MAX_FAULTS;  ///< largest number of waiting faults

  explicit FaultSchedule(const Parameters& parameters);  ///< allocates; no other member allocates

  void clear() noexcept;  ///< removes all waiting faults
  /// Queues a fault, which must be valid. @returns false if the schedule is full.
  bool push(const Fault& fault, Stamp stamp) noexcept;
  /// Whether any fault has a stamp that is not after `instant`.
  bool isDue(Stamp instant) const noexcept { return size_ > 0 && waiting_[size_ - 1].stamp <= instant; }
  /// Takes the earliest fault that is due. Drops a due fault if one of the same kind and place with a later stamp was
  /// taken before. @returns false if no fault is due.
  bool pop(Stamp instant, Fault& fault, Stamp& stamp) noexcept;

private:
  struct Waiting
  {
    Stamp stamp;
    Fault fault;
  };
  Stamp& lastTaken(const Fault& fault) noexcept;

  std::array<Waiting, CAPACITY> waiting_{};  // waiting faults, the latest first
  std::size_t size_{};
  // for each kind and place the stamp of the last taken fault; the first place stands for the whole part
  std::array<std::vector<Stamp>, FAULT_KINDS> last_taken_;
};
}  // namespace hjt
