// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/model/faults/fault_list.hpp"

namespace hjt
{
namespace
{
bool before(const Fault& a, const Fault& b) noexcept
{
  return a.kind != b.kind ? a.kind < b.kind : a.place < b.place;
}
}  // namespace

bool FaultList::set(const Fault& fault, std::int64_t since) noexcept
{
  std::size_t place = 0;
  while (place < size_ && before(faults_[place].fault, fault))
  {
    ++place;
  }
  const bool known = place < size_ && !before(fault, faults_[place].fault);
  if (fault.severity == 0.0)
  {
    if (known)
    {
      ++version_;
      for (--size_; place < size_; ++place)
      {
        faults_[place] = faults_[place + 1];
      }
    }
    return true;
  }
  if (known && faults_[place].fault.severity == fault.severity)
  {
    return true;
  }
  if (!known)
  {
    if (size_ == faults_.size())
    {
      return false;
    }
    for (std::size_t i = size_++; i > place; --i)
    {
      faults_[i] = faults_[i - 1];
    }
  }
  ++version_;
  faults_[place] = { fault, since };
  return true;
}
}  // namespace hjt
