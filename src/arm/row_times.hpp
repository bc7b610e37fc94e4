// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Errors of the stamps of an arm's rows, from the angles and the velocities recorded beside them.
///
/// The time between two rows is that in which the mean velocities v make the changes of angle dq, by least squares over
/// all joints, with the stamps' own interval d as an observation beside them:
///   e = (v.dq / ANGLE^2 + d / STAMP^2) / (v.v / ANGLE^2 + 1 / STAMP^2)
/// A log that stamps its rows evenly but took them unevenly, or lost one, shows as e other than d. Differences below
/// SIGNIFICANT are noise and passed over. A joint counts while its velocities agree with its angles and the stamps
/// within AGREES in the mean of the last seconds: one of the wrong sign or unit does not. Only the differences
/// between errors count, until the next gap. Nothing allocates or throws after construction.
class RowTimes
{
public:
  static constexpr double ANGLE = 1e-4;        ///< deviation of an angle's change from its velocity's integral [rad]
  static constexpr double STAMP = 4e-3;        ///< deviation of a stamp's interval [s]
  static constexpr double SIGNIFICANT = 0.35;  ///< of the interval by the stamps
  static constexpr double AGREES = 0.1;        ///< [-]

  explicit RowTimes(std::size_t joints) : last_(joints), agreements_(joints) {}

  /// Delay of the stamp of these rows, one of each joint [s]. The rows are later than those before.
  double stampError(const std::vector<MotionRow>& rows) noexcept
  {
    const double step = started_ ? rows.front().time - last_.front().time : HUGE_VAL;
    error_ = step > MotionDifferentiator::MAX_GAP ? 0.0 : error_ + step - interval(rows);
    std::copy(rows.begin(), rows.end(), last_.begin());
    started_ = true;
    return error_;
  }

  void reset() noexcept
  {
    std::fill(agreements_.begin(), agreements_.end(), Agreement{});
    started_ = false;
    error_ = 0.0;
  }

private:
  /// Of one joint: sums of v dq and v v d, forgotten over MEMORY. They begin in agreement.
  struct Agreement
  {
    double change{ START };
    double expected{ START };
  };
  static constexpr double MEMORY = 10.0;  // [s]
  static constexpr double START = 0.25;   // as after 1 s at 0.5 rad/s [rad^2/s]

  /// Between the last rows and these, by the motion where it says more than the stamps [s].
  double interval(const std::vector<MotionRow>& rows) noexcept
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

  std::vector<MotionRow> last_;
  std::vector<Agreement> agreements_;
  bool started_{};
  double error_{};
};
}  // namespace hjt
