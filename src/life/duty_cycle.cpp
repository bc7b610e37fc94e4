// SPDX-License-Identifier: BSD-3-Clause
#include "life/duty_cycle.hpp"

#include <array>
#include <cmath>

#include "base/number_table.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
namespace
{
NumberTable<4> tableOf(const std::string& path)
{
  return NumberTable<4>(path, { "duration", "motor_speed", "load_torque", "temperature" });
}
}  // namespace

bool DutyCycle::isOne(const std::string& path)
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

DutyCycle DutyCycle::fromFile(const std::string& path)
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

double DutyCycle::turnsPerHour() const
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
}  // namespace hjt
