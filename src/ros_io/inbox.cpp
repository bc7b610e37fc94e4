// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/inbox.hpp"

#include <algorithm>
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
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock() || inputs_.empty())
  {
    return;
  }
  const auto taken = inputs_.begin() + static_cast<std::ptrdiff_t>(std::min(inputs_.size(), CAPACITY - inputs.size()));
  inputs.insert(inputs.end(), inputs_.begin(), taken);
  inputs_.erase(inputs_.begin(), taken);
}

std::vector<Input> Inbox::makeBuffer()
{
  std::vector<Input> buffer;
  buffer.reserve(CAPACITY);
  return buffer;
}
}  // namespace hjt
