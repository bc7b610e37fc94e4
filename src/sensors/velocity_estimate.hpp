// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hjt
{
/// Velocity as a drive takes it from an encoder: the difference of two angles over a fixed time.
///
/// Law:   v = (a_k - a_(k-n)) / (n T),  n = window / T rounded, at least 1
/// where  a_k  angle at the k-th sample     [rad]
///        T    time between two samples     [s]
/// Until n + 1 angles have come in, the difference is taken over what there is; with one angle the velocity is zero.
class VelocityEstimate
{
public:
  /// `window`, `period`: over which the difference is taken, between two samples [s].
  VelocityEstimate(double window, double period)
    : period_(period), angles_(1 + std::max<std::size_t>(1, std::lround(window / period)))
  {
  }

  void reset() noexcept { count_ = 0; }

  /// Once every period [rad]
  void update(double angle) noexcept
  {
    newest_ = newest_ + 1 == angles_.size() ? 0 : newest_ + 1;
    angles_[newest_] = angle;
    count_ = std::min(count_ + 1, angles_.size());
  }

  /// `resolved`: of an angle kept, what an encoder makes of it [rad]. @returns [rad/s]
  template <class Resolved>
  double velocity(Resolved&& resolved) const noexcept
  {
    if (count_ < 2)
    {
      return 0.0;
    }
    const std::size_t intervals = count_ - 1;
    const std::size_t oldest = newest_ >= intervals ? newest_ - intervals : newest_ + angles_.size() - intervals;
    return (resolved(angles_[newest_]) - resolved(angles_[oldest])) / (static_cast<double>(intervals) * period_);
  }

private:
  double period_;
  std::vector<double> angles_;  // ring of n + 1
  std::size_t newest_{};
  std::size_t count_{};  // angles held
};
}  // namespace hjt
