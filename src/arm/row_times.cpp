// SPDX-License-Identifier: BSD-3-Clause
#include "arm/row_times.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
/// Between the last rows and these, by the motion where it says more than the stamps [s].
double RowTimes::interval(const std::vector<MotionRow>& rows) noexcept
{
  const double by_stamps = rows.front().time - last_.front().time;
  double weight = 1.0 / (STAMP * STAMP);
  double weighted = by_stamps * weight;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const double velocity = 0.5 * (rows[i].recorded_velocity + last_[i].recorded_velocity);
    if (!std::isfinite(velocity))
    {
      continue;
    }
    const double change = rows[i].position - last_[i].position;
    Agreement& agreement = agreements_[i];
    const double kept = 1.0 - by_stamps / MEMORY;
    agreement.change = kept * agreement.change + velocity * change;
    agreement.expected = kept * agreement.expected + velocity * velocity * by_stamps;
    if (std::abs(agreement.change - agreement.expected) <= AGREES * agreement.expected)
    {
      weight += velocity * velocity / (ANGLE * ANGLE);
      weighted += velocity * change / (ANGLE * ANGLE);
    }
  }
  const double by_motion = weighted / weight;
  const double difference = std::abs(by_motion - by_stamps);
  constexpr double MOST = 4.0;  // a damaged angle
  const bool is_usable = by_motion > by_stamps / MOST && by_motion < by_stamps * MOST;
  return is_usable && difference > SIGNIFICANT * by_stamps ? by_motion : by_stamps;
}

void RowTimes::reset() noexcept
{
  std::fill(agreements_.begin(), agreements_.end(), Agreement{});
  started_ = false;
  error_ = 0.0;
}

double RowTimes::stampError(const std::vector<MotionRow>& rows) noexcept
{
  const double step = started_ ? rows.front().time - last_.front().time : HUGE_VAL;
  error_ = step > MotionDifferentiator::MAX_GAP ? 0.0 : error_ + step - interval(rows);
  std::copy(rows.begin(), rows.end(), last_.begin());
  started_ = true;
  return error_;
}
}  // namespace hjt
