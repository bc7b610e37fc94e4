// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "base/csv_table.hpp"
#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

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
  static DutyCycle fromFile(const std::string& path)
  {
    // Beyond these no drive lives or works; sums over as many rows as a file may have stay finite.
    constexpr Range ALLOWED[] = { { 1e-9, 1e10 }, { -1e5, 1e5 }, { -1e6, 1e6 }, { MIN_TEMPERATURE, MAX_TEMPERATURE } };
    constexpr const char* UNITS[] = { "s", "rad/s", "N.m", "degC" };
    NumberTable<4> table = tableOf(path);
    DutyCycle duty;
    for (std::array<double, 4> row{}; table.read(row);)
    {
      for (std::size_t i = 0; i < row.size(); ++i)
      {
        table.requireRange(i, row[i], ALLOWED[i], UNITS[i]);
      }
      duty.phases.push_back({ row[0], std::abs(row[1]), row[2], row[3] });
    }
    if (duty.turnsPerHour() == 0.0)
    {
      throw InputError(path + ": the motor never turns");
    }
    return duty;
  }

  /// Whether the file can be read and its first line names these columns, whatever follows.
  static bool isOne(const std::string& path)
  {
    try
    {
      tableOf(path);
      return true;
    }
    catch (const InputError&)
    {
      return false;
    }
  }

  double turnsPerHour() const
  {
    double turns = 0.0;
    double time = 0.0;
    for (const DutyPhase& phase : phases)
    {
      turns += phase.turns();
      time += phase.duration;
    }
    return time > 0.0 ? 3600.0 * turns / time : 0.0;
  }

private:
  static NumberTable<4> tableOf(const std::string& path)
  {
    return NumberTable<4>(path, { "duration", "motor_speed", "load_torque", "temperature" });
  }
};

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
