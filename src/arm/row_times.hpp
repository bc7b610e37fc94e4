// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
/// SIGNIFICANT are noise and passed over. Only the differences between errors count, until the next gap. A recording
/// without velocities keeps its stamps. Nothing allocates or throws after construction.
class RowTimes
{
public:
  static constexpr double ANGLE = 1e-4;        ///< deviation of an angle's change from its velocity's integral [rad]
  static constexpr double STAMP = 4e-3;        ///< deviation of a stamp's interval [s]
  static constexpr double SIGNIFICANT = 0.35;  ///< of the interval by the stamps

  explicit RowTimes(std::size_t joints) : last_(joints) {}

  /// What the stamp of these rows, one of each joint, is late by [s]. The rows are later than those before.
  double stampError(const std::vector<MotionRow>& rows) noexcept;

  void reset() noexcept
  {
    started_ = false;
    error_ = 0.0;
  }

private:
  double interval(const std::vector<MotionRow>& rows) const noexcept;

  std::vector<MotionRow> last_;
  bool started_{};
  double error_{};
};
}  // namespace hjt
