// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "gear/angle.hpp"

namespace hjt
{
/// A stretch of steady work.
struct DutyPhase
{
  double duration{};     ///< > 0 [s]
  double motor_speed{};  ///< its magnitude counts [rad/s]
  double load_torque{};  ///< at the output [N.m]
  double temperature{};  ///< of the drive [degC]

  double turns() const { return duration * motor_speed / TWO_PI; }  ///< of the wave generator, >= 0
};

/// The repeated motion of the joint.
struct DutyCycle
{
  std::vector<DutyPhase> phases;

  /// CSV with the columns duration (1e-9 ... 1e10 s), motor_speed (-1e5 ... 1e5 rad/s), load_torque (-1e6 ... 1e6 N.m)
  /// and temperature (-40 ... 150 degC). @throws InputError naming line, column, value, unit and range.
  static DutyCycle fromFile(const std::string& path);

  /// Whether the file can be read and its first line names these columns, whatever follows.
  static bool isOne(const std::string& path);

  double turnsPerHour() const;
};
}  // namespace hjt
