// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "life/duty_cycle.hpp"

namespace hjt
{
/// How a drive has been used: time and turns by load and temperature, in fixed memory however long that was.
///
/// The nodes lie every sixteenth of the rated torque, up to four times it either way, and every 10 K. A stretch of use
/// is shared among the four nodes around it so that time, turns, mean load and temperature of both stay as they were.
class UsageHistory
{
public:
  explicit UsageHistory(const LifeParameters& life);

  /// From a file that holds `text`, or any other duty cycle. @throws InputError.
  UsageHistory(const LifeParameters& life, const std::string& path);

  void clear() noexcept;
  void add(const DutyPhase& use) noexcept;  ///< values beyond the nodes count as the outermost ones
  void add(const UsageHistory& other) noexcept;

  double hours() const noexcept;
  double turns() const noexcept;  ///< of the wave generator, both ways

  /// A phase for each node in use: the duty cycle that has been gone through once.
  DutyCycle duty() const;

  /// The use as a duty cycle that `joint_twin life` reads.
  std::string text() const;

private:
  static constexpr std::size_t LOADS = 129;
  static constexpr std::size_t TEMPERATURES = 20;
  struct Node
  {
    double time{};    // [s]
    double travel{};  // of the wave generator [rad]
  };

  double load_step_;  // [N.m]
  std::array<std::array<Node, TEMPERATURES>, LOADS> nodes_{};
};
}  // namespace hjt
