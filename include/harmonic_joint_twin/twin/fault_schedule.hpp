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
/// Faults that were injected, since reset.
struct FaultCounters
{
  std::uint64_t accepted{};  ///< queued
  std::uint64_t refused{};   ///< severity, place or onset out of its range
  std::uint64_t late{};      ///< stamp before the instant already simulated: sets in at once
  std::uint64_t no_room{};   ///< too many waiting or active: refused
};

/// Faults that are to set in or to be taken away, in order of time, in a fixed store. Equal stamps keep the order of
/// arrival.
class FaultSchedule
{
public:
  static constexpr std::size_t CAPACITY = 2 * MAX_FAULTS;  ///< most that wait

  explicit FaultSchedule(const Parameters& parameters);  ///< allocates; later members do not

  void clear() noexcept;  ///< forgets all
  /// `fault` valid. @returns false if it is full.
  bool push(const Fault& fault, Stamp stamp) noexcept;
  /// Whether one has a stamp not after `instant`.
  bool isDue(Stamp instant) const noexcept { return size_ > 0 && waiting_[size_ - 1].stamp <= instant; }
  /// Takes the earliest that is due. False: there is none. One that comes late, after a newer one of its kind and place
  /// was taken, is dropped.
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
  std::array<std::vector<Stamp>, FAULT_KINDS> last_taken_;  // by kind and place, the whole member first
};
}  // namespace hjt
