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
constexpr std::size_t INPUT_KINDS = 4;  ///< number of values of InputKind

/// Input of a twin with its stamp.
struct Input
{
  Stamp stamp{};     ///< time from which the input acts [ns]
  InputKind kind{};  ///< meaning of `value`
  double value{};    ///< torque [N.m], temperature [degC], or 1 for an engaged brake
};

/// Fault with the time at which it sets in.
struct StampedFault
{
  Stamp stamp{};  ///< time from which the fault is active [ns]
  Fault fault{};
};

/// Any input of the twin, with the time from which it acts.
using TwinInput = std::variant<Input, StampedFault>;

/// Time from which the input acts [ns].
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

/// Numbers of inputs since the queue was cleared.
struct InputCounters
{
  std::uint64_t accepted{};    ///< inputs that were queued, including late ones
  std::uint64_t not_finite{};  ///< inputs that were refused because they are NaN or infinite
  std::uint64_t late{};        ///< inputs with a stamp before the simulated instant, which act at once
  std::uint64_t overflow{};    ///< inputs that were dropped: a full queue drops its oldest input
};

/// Inputs, ordered by time. Inputs with equal stamps stay in the order of their arrival. The storage has a fixed size.
class InputQueue
{
public:
  static constexpr std::size_t CAPACITY = 4096;  ///< largest number of waiting inputs

  void clear() noexcept;                              ///< removes all inputs and resets the counters
  bool empty() const noexcept { return size_ == 0; }  ///< whether no input waits

  /// Queues an input. `now`: simulated instant. An input with a stamp before `now` counts as late.
  void push(const Input& input, Stamp now) noexcept;

  /// Whether any input has a stamp that is not after `instant`.
  bool isDue(Stamp instant) const noexcept { return size_ > 0 && inputs_[first_].stamp <= instant; }

  /// Takes the earliest input that is due. @returns false if no input is due.
  bool pop(Stamp instant, Input& input) noexcept;

  const InputCounters& counters() const noexcept { return counters_; }  ///< numbers of inputs since the last clear

private:
  std::array<Input, CAPACITY> inputs_{};
  std::size_t first_{};
  std::size_t size_{};
  InputCounters counters_{};
};
}  // namespace hjt
