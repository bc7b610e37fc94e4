// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "harmonic_joint_twin/params/faults.hpp"

namespace hjt
{
/// A fault in force.
struct ActiveFault
{
  Fault fault;           ///< what it is
  std::int64_t since{};  ///< stamp of its present severity [ns]
};

/// Faults by kind and place, in that order whatever order they came in; in a fixed store.
class FaultList
{
public:
  /// Adds a fault, or replaces the severity of the one of its kind and place; severity 0 takes it away.
  /// Faults that have these values already keep their stamp. @returns false if there is no room: nothing is changed.
  bool set(const Fault& fault, std::int64_t since) noexcept;
  void clear() noexcept  ///< takes all away
  {
    version_ += size_ > 0 ? 1 : 0;
    size_ = 0;
  }

  const ActiveFault* begin() const noexcept { return faults_.data(); }        ///< first
  const ActiveFault* end() const noexcept { return faults_.data() + size_; }  ///< behind the last
  std::size_t size() const noexcept { return size_; }                         ///< 0 ... MAX_FAULTS
  bool empty() const noexcept { return size_ == 0; }                          ///< no fault is active
  std::uint64_t version() const noexcept { return version_; }  ///< another one whenever the list has changed

private:
  std::array<ActiveFault, MAX_FAULTS> faults_{};
  std::size_t size_{};
  std::uint64_t version_{};
};
}  // namespace hjt
