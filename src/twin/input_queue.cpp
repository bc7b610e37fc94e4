// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/input_queue.hpp"

#include <cmath>

namespace hjt
{
void InputQueue::clear() noexcept
{
  first_ = 0;
  size_ = 0;
  counters_ = {};
}

void InputQueue::push(const Input& input, Stamp now) noexcept
{
  if (!std::isfinite(input.value))
  {
    ++counters_.not_finite;
    return;
  }
  if (size_ == CAPACITY)
  {
    ++counters_.overflow;
    if (input.stamp < inputs_[first_].stamp)
    {
      return;  // the new input is older than all inputs in the queue
    }
    first_ = (first_ + 1) % CAPACITY;
    --size_;
  }
  ++counters_.accepted;
  if (input.stamp < now)
  {
    ++counters_.late;
  }

  // The search for the place starts at the end, because stamps nearly always ascend.
  std::size_t place = size_;
  while (place > 0)
  {
    const Input& earlier = inputs_[(first_ + place - 1) % CAPACITY];
    if (earlier.stamp <= input.stamp)
    {
      break;
    }
    inputs_[(first_ + place) % CAPACITY] = earlier;
    --place;
  }
  inputs_[(first_ + place) % CAPACITY] = input;
  ++size_;
}

bool InputQueue::pop(Stamp instant, Input& input) noexcept
{
  if (!isDue(instant))
  {
    return false;
  }
  input = inputs_[first_];
  --size_;
  // An empty queue starts again at 0, so that the used part of the storage stays in the processor's cache.
  first_ = size_ == 0 ? 0 : (first_ + 1) % CAPACITY;
  return true;
}
}  // namespace hjt
