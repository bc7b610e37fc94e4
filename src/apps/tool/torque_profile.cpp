// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tool/torque_profile.hpp"

#include <cmath>

#include "base/number_table.hpp"

namespace hjt
{
namespace
{
enum ProfileColumn
{
  TIME,
  MOTOR_TORQUE,
  LOAD_TORQUE,
  BRAKE,
  COLUMNS
};

constexpr Range TIMES{ 0.0, 1e9 };  // a stamp holds them [s]
}  // namespace

TorqueProfile TorqueProfile::constant(double motor_torque)
{
  TorqueProfile profile;
  profile.inputs_.push_back({ 0, InputKind::MOTOR_TORQUE, motor_torque });
  return profile;
}

TorqueProfile TorqueProfile::fromFile(const std::string& path)
{
  constexpr std::size_t OPTIONAL_COLUMNS = 2;
  NumberTable<COLUMNS> table(path, { "time", "motor_torque", "load_torque", "brake" }, OPTIONAL_COLUMNS);
  TorqueProfile profile;
  profile.has_load_ = table.hasColumn(LOAD_TORQUE);
  std::array<double, COLUMNS> row{};
  for (double last = -1.0; table.read(row); last = row[TIME])
  {
    if (row[TIME] < 0.0 || row[TIME] <= last)
    {
      throw InputError(table.place() + ": column 'time' must start at 0 or later and ascend");
    }
    table.requireRange(TIME, row[TIME], TIMES, "s");
    const auto stamp = static_cast<Stamp>(std::llround(row[TIME] * 1e9));
    profile.inputs_.push_back({ stamp, InputKind::MOTOR_TORQUE, row[MOTOR_TORQUE] });
    if (table.hasColumn(LOAD_TORQUE))
    {
      profile.inputs_.push_back({ stamp, InputKind::LOAD_TORQUE, row[LOAD_TORQUE] });
    }
    if (table.hasColumn(BRAKE))
    {
      if (row[BRAKE] != 0.0 && row[BRAKE] != 1.0)
      {
        throw InputError(table.place() + ": column 'brake' must be 0 or 1");
      }
      profile.inputs_.push_back({ stamp, InputKind::BRAKE, row[BRAKE] });
    }
  }
  if (profile.inputs_.empty())
  {
    throw InputError(path + " has no rows");
  }
  return profile;
}

void TorqueProfile::setLoad(double load_torque)
{
  has_load_ = true;
  inputs_.insert(inputs_.begin(), { 0, InputKind::LOAD_TORQUE, load_torque });
}

Stamp TorqueProfile::duration() const
{
  return inputs_.back().stamp;
}

void TorqueProfile::feed(Twin& twin, Stamp begin)
{
  // A profile holds its torque for any time; the command is repeated at every instant, so it does not time out.
  twin.commandMotorTorque(twin.stamp(), motor_torque_);
  const Stamp end = twin.stamp() + twin.stepLength();
  for (; next_ < inputs_.size() && begin + inputs_[next_].stamp < end; ++next_)
  {
    const Input& input = inputs_[next_];
    motor_torque_ = input.kind == InputKind::MOTOR_TORQUE ? input.value : motor_torque_;
    twin.push({ begin + input.stamp, input.kind, input.value });
  }
}
}  // namespace hjt
