// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/motion_differentiator.hpp"

#include <cmath>

#include <Eigen/Core>
#include <Eigen/LU>

namespace hjt
{
bool MotionDifferentiator::push(const MotionRow& row) noexcept
{
  const bool finite =
      std::isfinite(row.time) && std::isfinite(row.position) && std::isfinite(row.current) && std::isfinite(row.load);
  const double last = end_ > 0 ? rows_[(end_ - 1) % ROOM].time : -HUGE_VAL;
  if (!finite || row.time < last + MIN_STEP)
  {
    ++refused_;
    return false;
  }
  segment_ += end_ > 0 && row.time > last + MAX_GAP ? 1 : 0;
  rows_[end_ % ROOM] = row;
  points_[end_ % ROOM] = { row.time - row.stamp_error, row.position, segment_ };
  ++end_;
  return true;
}

std::optional<MotionSample> MotionDifferentiator::pop(bool at_end) noexcept
{
  if (next_ == end_)
  {
    return std::nullopt;
  }
  const Point& newest = at(end_ - 1);
  const bool known =
      newest.segment != at(next_).segment || (end_ > next_ + MIN_SIDE && newest.time >= at(next_).time + half_width_);
  if (!known && !at_end)
  {
    return std::nullopt;
  }
  return fit(next_++);
}

MotionSample MotionDifferentiator::fit(std::uint64_t index) const noexcept
{
  const Point& centre = at(index);
  MotionSample sample;
  static_cast<MotionRow&>(sample) = rows_[index % ROOM];
  sample.after_gap = index > 0 && at(index - 1).segment != centre.segment;

  // Sums of the powers of the time t, and sums of the products of these powers with the angle. The unit of t is the
  // half width, so that all sums are of the same order of magnitude.
  int rows = 0;
  std::array<double, 4> powers{};
  std::array<double, 3> products{};
  const auto take = [&](const Point& point, std::uint64_t distance)
  {
    const double t = (point.time - centre.time) / half_width_;
    if (point.segment != centre.segment || (std::abs(t) > 1.0 && distance > MIN_SIDE))
    {
      return false;
    }
    const double square = t * t;
    const double angle = point.position - centre.position;
    powers = { powers[0] + t, powers[1] + square, powers[2] + t * square, powers[3] + square * square };
    products = { products[0] + angle, products[1] + t * angle, products[2] + square * angle };
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
    Eigen::Matrix3d normal;
    normal << rows, powers[0], powers[1], powers[0], powers[1], powers[2], powers[1], powers[2], powers[3];
    const Eigen::Vector3d parabola = normal.inverse() * Eigen::Vector3d(products[0], products[1], products[2]);
    sample.velocity = parabola[1] / half_width_;
    sample.acceleration = 2.0 * parabola[2] / (half_width_ * half_width_);
  }
  return sample;
}
}  // namespace hjt
