// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/velocity_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
VelocityEstimate::VelocityEstimate(double window, double period)
  : period_(period), angles_(1 + std::max<std::size_t>(1, std::lround(window / period)))
{
}

void VelocityEstimate::reset() noexcept
{
  count_ = 0;
}

void VelocityEstimate::update(double angle) noexcept
{
  newest_ = newest_ + 1 == angles_.size() ? 0 : newest_ + 1;
  angles_[newest_] = angle;
  count_ = std::min(count_ + 1, angles_.size());
}

double VelocityEstimate::velocity() const noexcept
{
  if (count_ < 2)
  {
    return 0.0;
  }
  const std::size_t intervals = count_ - 1;
  const std::size_t oldest = newest_ >= intervals ? newest_ - intervals : newest_ + angles_.size() - intervals;
  return (angles_[newest_] - angles_[oldest]) / (static_cast<double>(intervals) * period_);
}
}  // namespace hjt
