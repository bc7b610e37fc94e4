// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "harmonic_joint_twin/params/faults.hpp"

namespace hjt
{
/// Active fault of a drive.
struct ActiveFault
{
  Fault fault;           ///< kind, severity and place
  std::int64_t since{};  ///< time from which the fault has its present severity [ns]
};

/// Active faults, ordered by kind and place. The storage has a fixed size.
class FaultList
{
public:
  /// Adds a fault, or changes the severity of the fault of this kind and place. The severity 0 removes the fault. If
  /// the severity does not change, the fault keeps its `since`. @returns false and changes nothing if the list is full.
  bool set(const Fault& fault, std::int64_t since) noexcept;
  void clear() noexcept  ///< removes all faults
  {
    version_ += size_ > 0 ? 1 : 0;
    size_ = 0;
  }

  const ActiveFault* begin() const noexcept { return faults_.data(); }        ///< first fault
  const ActiveFault* end() const noexcept { return faults_.data() + size_; }  ///< end of the faults
  std::size_t size() const noexcept { return size_; }                         ///< number of faults, 0 ... MAX_FAULTS
  bool empty() const noexcept { return size_ == 0; }                          ///< whether no fault is active
  std::uint64_t version() const noexcept { return version_; }                 ///< number that changes with the list

private:
  std::array<ActiveFault, MAX_FAULTS> faults_{};
  std::size_t size_{};
  std::uint64_t version_{};
};
}  // namespace hjt
