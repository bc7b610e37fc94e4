// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>

#include "harmonic_joint_twin/base/stamp.hpp"
#include "harmonic_joint_twin/params/faults.hpp"

namespace hjt
{
enum class InputKind : std::uint8_t
{
  MOTOR_TORQUE,
  LOAD_TORQUE,
  BRAKE,
  TEMPERATURE
};
constexpr std::size_t INPUT_KINDS = 4;  ///< number of kinds

/// One stamped input of a twin.
struct Input
{
  Stamp stamp{};     ///< acts from here on [ns]
  InputKind kind{};  ///< meaning of `value`
  double value{};    ///< torque [N.m], temperature [degC], or 1 for an engaged brake
};

/// A fault that sets in at a time.
struct StampedFault
{
  Stamp stamp{};  ///< time from which the fault is active [ns]
  Fault fault{};
};

/// An input of the twin, with the time from which it acts.
using TwinInput = std::variant<Input, StampedFault>;

/// When it acts [ns].
inline Stamp& stampOf(TwinInput& input) noexcept
{
  auto* fault = std::get_if<StampedFault>(&input);
  return fault != nullptr ? fault->stamp : std::get_if<Input>(&input)->stamp;
}
inline Stamp stampOf(const TwinInput& input) noexcept
{
  const auto* fault = std::get_if<StampedFault>(&input);
  return fault != nullptr ? fault->stamp : std::get_if<Input>(&input)->stamp;
}

/// Inputs of a queue since it was cleared.
struct InputCounters
{
  std::uint64_t accepted{};    ///< queued, late ones too
  std::uint64_t not_finite{};  ///< NaN or Inf: refused
  std::uint64_t late{};        ///< stamp before the instant already simulated: acts at once
  std::uint64_t overflow{};    ///< queue full: oldest dropped
};

/// Stamped inputs in order of time, in a fixed store. Equal stamps keep the order of arrival.
class InputQueue
{
public:
  static constexpr std::size_t CAPACITY = 4096;  ///< most that wait

  void clear() noexcept;                              ///< forgets all, and the counters
  bool empty() const noexcept { return size_ == 0; }  ///< none waits

  /// `now`: up to where has been simulated; an earlier stamp is late.
  void push(const Input& input, Stamp now) noexcept;

  /// Whether an input has a stamp not after `instant`.
  bool isDue(Stamp instant) const noexcept { return size_ > 0 && inputs_[first_].stamp <= instant; }

  /// Takes the earliest input that is due. False: there is none.
  bool pop(Stamp instant, Input& input) noexcept;

  const InputCounters& counters() const noexcept { return counters_; }  ///< since clear

private:
  std::array<Input, CAPACITY> inputs_{};
  std::size_t first_{};
  std::size_t size_{};
  InputCounters counters_{};
};
}  // namespace hjt
