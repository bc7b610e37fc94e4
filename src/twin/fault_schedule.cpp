// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/fault_schedule.hpp"

namespace hjt
{
bool FaultSchedule::push(const Fault& fault, Stamp stamp) noexcept
{
  if (size_ == CAPACITY)
  {
    return false;
  }
  std::size_t place = size_++;
  for (; place > 0 && waiting_[place - 1].stamp <= stamp; --place)
  {
    waiting_[place] = waiting_[place - 1];
  }
  waiting_[place] = { stamp, fault };
  return true;
}

bool FaultSchedule::pop(Stamp instant, Fault& fault, Stamp& stamp) noexcept
{
  if (size_ == 0 || waiting_[size_ - 1].stamp > instant)
  {
    return false;
  }
  --size_;
  fault = waiting_[size_].fault;
  stamp = waiting_[size_].stamp;
  return true;
}
}  // namespace hjt
