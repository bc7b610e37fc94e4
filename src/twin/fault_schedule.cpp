// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/fault_schedule.hpp"

#include <algorithm>
#include <limits>

namespace hjt
{
FaultSchedule::FaultSchedule(const Parameters& parameters)
{
  for (std::size_t kind = 0; kind < FAULT_KINDS; ++kind)
  {
    const int places = lastPlace(static_cast<FaultKind>(kind), parameters) - WHOLE_MEMBER + 1;
    last_taken_[kind].resize(static_cast<std::size_t>(places));
  }
  clear();
}

void FaultSchedule::clear() noexcept
{
  size_ = 0;
  for (std::vector<Stamp>& stamps : last_taken_)
  {
    std::fill(stamps.begin(), stamps.end(), std::numeric_limits<Stamp>::min());
  }
}

Stamp& FaultSchedule::lastTaken(const Fault& fault) noexcept
{
  return last_taken_[static_cast<std::size_t>(fault.kind)][static_cast<std::size_t>(fault.place - WHOLE_MEMBER)];
}

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
  while (isDue(instant))
  {
    --size_;
    fault = waiting_[size_].fault;
    stamp = waiting_[size_].stamp;
    Stamp& last = lastTaken(fault);
    if (stamp >= last)
    {
      last = stamp;
      return true;
    }
  }
  return false;
}
}  // namespace hjt
