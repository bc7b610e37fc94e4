// SPDX-License-Identifier: BSD-3-Clause
#include "life/duty_cycle.hpp"

#include <array>
#include <cmath>

#include "base/number_table.hpp"

namespace hjt
{
DutyCycle DutyCycle::fromFile(const std::string& path)
{
  NumberTable<4> table(path, { "duration", "motor_speed", "load_torque", "temperature" });
  DutyCycle duty;
  for (std::array<double, 4> row{}; table.read(row);)
  {
    if (row[0] <= 0.0)
    {
      throw InputError(table.place() + ": column 'duration' must be more than 0 [s]");
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
