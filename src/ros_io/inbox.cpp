// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/inbox.hpp"

#include <cmath>

namespace hjt
{
Inbox::Inbox() : inputs_(makeBuffer()) {}

void Inbox::push(const Input& input)
{
  if (!std::isfinite(input.value))
  {
    ++not_finite_;
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (inputs_.size() == CAPACITY)
  {
    ++overflow_;
    return;
  }
  inputs_.push_back(input);
}

void Inbox::take(std::vector<Input>& inputs) noexcept
{
  inputs.clear();
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (lock.owns_lock())
  {
    inputs_.swap(inputs);
  }
}

std::vector<Input> Inbox::makeBuffer()
{
  std::vector<Input> buffer;
  buffer.reserve(CAPACITY);
  return buffer;
}
}  // namespace hjt
