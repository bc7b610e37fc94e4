// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/twin/input_queue.hpp"

namespace hjt
{
/// The topics the twin puts out.
enum class Output : std::size_t
{
  JOINT_STATES,
  ENCODERS,
  CONTACT_FORCES,
  HEALTH,
  INDICATORS,
  ASSESSMENT
};
constexpr std::size_t OUTPUT_COUNT = 6;

/// Which topic is due at which simulated instant. Ask after every step of the twin.
///
/// A topic is due when the instant is a whole multiple of its period, counted from the epoch and not from the start:
/// the same input gives messages at the same instants however it was cut, live, replayed or offline.
class OutputSchedule
{
public:
  /// @param parameters as read: every publish rate divides solver.rate.
  explicit OutputSchedule(const Parameters& parameters);

  bool isDue(Output output, Stamp instant) const noexcept { return instant % period(output) == 0; }

  Stamp period(Output output) const noexcept { return periods_[static_cast<std::size_t>(output)]; }  ///< [ns]

private:
  std::array<Stamp, OUTPUT_COUNT> periods_{};
};
}  // namespace hjt
