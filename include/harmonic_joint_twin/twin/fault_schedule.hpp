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
/// Counts of injected faults since the last reset.
struct FaultCounters
{
  std::uint64_t accepted{};  ///< faults that were queued
  std::uint64_t refused{};   ///< faults whose severity, place or onset is out of range
  std::uint64_t late{};      ///< faults with a stamp before the simulated instant; they set in at once
  std::uint64_t no_room{};   ///< faults that were refused because too many wait or are active
};

/// Faults that will set in or end, ordered by time; equal stamps keep their order of arrival. The storage has a fixed
/// size.
class FaultSchedule
{
public:
  static constexpr std::size_t CAPACITY = 2 * MAX_FAULTS;  ///< largest number of waiting faults

  explicit FaultSchedule(const Parameters& parameters);  ///< allocates; the other members do not

  void clear() noexcept;  ///< removes all waiting faults
  /// Queues a valid fault. @returns false if the schedule is full.
  bool push(const Fault& fault, Stamp stamp) noexcept;
  /// Whether a fault has a stamp not after `instant`.
  bool isDue(Stamp instant) const noexcept { return size_ > 0 && waiting_[size_ - 1].stamp <= instant; }
  /// Takes the earliest fault that is due. @returns false if none is due. Drops a late fault if a newer one of its kind
  /// and place was already taken.
  bool pop(Stamp instant, Fault& fault, Stamp& stamp) noexcept;

private:
  struct Waiting
  {
    Stamp stamp;
    Fault fault;
  };
  Stamp& lastTaken(const Fault& fault) noexcept;

  std::array<Waiting, CAPACITY> waiting_{};  // latest first
  std::size_t size_{};
  // stamp of the last fault taken, by kind and place, with the whole part first
  std::array<std::vector<Stamp>, FAULT_KINDS> last_taken_;
};
}  // namespace hjt
