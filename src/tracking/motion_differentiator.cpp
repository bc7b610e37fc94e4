// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/motion_differentiator.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace hjt
{
bool MotionDifferentiator::push(const MotionRow& row) noexcept
{
  const bool finite =
      std::isfinite(row.time) && std::isfinite(row.position) && std::isfinite(row.current) && std::isfinite(row.load);
  if (!finite || (end_ > 0 && row.time < at(end_ - 1).row.time + MIN_STEP))
  {
    ++refused_;
    return false;
  }
  if (end_ > 0 && row.time > at(end_ - 1).row.time + MAX_GAP)
  {
    ++segment_;
  }
  rows_[end_ % ROOM] = { row, segment_ };
  ++end_;
  return true;
}

std::optional<MotionSample> MotionDifferentiator::pop(bool at_end) noexcept
{
  if (next_ == end_)
  {
    return std::nullopt;
  }
  const Held& newest = at(end_ - 1);
  const bool known = newest.segment != at(next_).segment ||
                     (end_ > next_ + MIN_SIDE && trueTime(newest) >= trueTime(at(next_)) + half_width_);
  if (!known && !at_end)
  {
    return std::nullopt;
  }
  return fit(next_++);
}

MotionSample MotionDifferentiator::fit(std::uint64_t index) const noexcept
{
  const Held& centre = at(index);
  MotionSample sample;
  static_cast<MotionRow&>(sample) = centre.row;
  sample.after_gap = index > 0 && at(index - 1).segment != centre.segment;

  // Times by the half width, so that the sums are of one size.
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int rows = 0;
  const auto take = [&](const Held& held, std::uint64_t distance)
  {
    const double t = (trueTime(held) - trueTime(centre)) / half_width_;
    if (held.segment != centre.segment || (std::abs(t) > 1.0 && distance > MIN_SIDE))
    {
      return false;
    }
    const Eigen::Vector3d powers(1.0, t, t * t);
    normal += powers * powers.transpose();
    right += powers * (held.row.position - centre.row.position);
    ++rows;
    return true;
  };
  for (std::uint64_t i = index; i < end_ && take(at(i), i - index); ++i)
  {
  }
  for (std::uint64_t i = index; i > 0 && end_ - i < ROOM && take(at(i - 1), index - i + 1); --i)
  {
  }
  if (rows >= MIN_ROWS)
  {
    const Eigen::Vector3d parabola = normal.ldlt().solve(right);
    sample.velocity = parabola[1] / half_width_;
    sample.acceleration = 2.0 * parabola[2] / (half_width_ * half_width_);
  }
  return sample;
}
}  // namespace hjt
