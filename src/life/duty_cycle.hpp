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
/// A period with constant speed, load and temperature.
struct DutyPhase
{
  double duration{};     ///< length of the period, > 0 [s]
  double motor_speed{};  ///< speed of the motor, of which only the magnitude counts [rad/s]
  double load_torque{};  ///< load torque at the output [N.m]
  double temperature{};  ///< temperature of the drive [degC]

  double turns() const { return duration * motor_speed / TWO_PI; }  ///< turns of the wave generator, >= 0
};

/// The sequence of phases that the joint repeats.
struct DutyCycle
{
  std::vector<DutyPhase> phases;

  /// Reads a CSV file with the columns duration (1e-9 ... 1e10 s), motor_speed (-1e5 ... 1e5 rad/s), load_torque (-1e6
  /// ... 1e6 N.m) and temperature (-40 ... 150 degC). @throws InputError with line, column, value, unit and range.
  static DutyCycle fromFile(const std::string& path)
  {
    // The ranges contain all real drives, and sums over the largest file stay finite.
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
      throw InputError(path + ": the motor turns in none of the phases");
    }
    return duty;
  }

  /// Whether the file can be read and has a first line with the columns of a duty cycle.
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

/// Use of a drive: time and turns by load and temperature, in storage of fixed size.
///
/// The grid has a node at every sixteenth of the rated torque, up to four times the rated torque in both directions,
/// and at every 10 K. The class divides a period of use among the four nodes around its load and temperature such that
/// time, turns, mean load and mean temperature are conserved.
class UsageHistory
{
public:
  explicit UsageHistory(const LifeParameters& life);

  /// Reads the use from a file with the result of `text`, or from any other duty cycle. @throws InputError.
  UsageHistory(const LifeParameters& life, const std::string& path);

  void clear() noexcept;
  void add(const DutyPhase& use) noexcept;  ///< adds a period; values beyond the grid count for its outermost nodes
  void add(const UsageHistory& other) noexcept;

  double hours() const noexcept;
  double turns() const noexcept;  ///< turns of the wave generator in both directions

  /// The whole use as one duty cycle, with a phase for each used node of the grid.
  DutyCycle duty() const;

  /// Text of a file with the use, which `joint_twin life` reads as a duty cycle.
  std::string text() const;

private:
  static constexpr std::size_t LOADS = 129;
  static constexpr std::size_t TEMPERATURES = 20;
  struct Node
  {
    double time{};    // [s]
    double travel{};  // travel of the wave generator in both directions [rad]
  };

  double load_step_;  // distance of the nodes in load [N.m]
  std::array<std::array<Node, TEMPERATURES>, LOADS> nodes_{};
};
}  // namespace hjt
