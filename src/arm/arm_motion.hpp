// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "arm/arm_dynamics.hpp"

namespace hjt
{
/// All joints of an arm at one time of a commanded motion.
struct ArmSetPoint
{
  double time{};                    ///< [s]
  std::vector<JointMotion> joints;  ///< all
};

/// A commanded motion between its set points: angles by cubics that have the set points' angles and speeds,
/// accelerations linear between theirs. Before the first and after the last it stands still there.
class ArmMotion
{
public:
  /// At least one set point, in order of time; otherwise undefined.
  explicit ArmMotion(std::vector<ArmSetPoint> points) : points_(std::move(points)) {}

  double begin() const noexcept { return points_.front().time; }  ///< [s]
  double end() const noexcept { return points_.back().time; }     ///< [s]
  std::size_t joints() const noexcept { return points_.front().joints.size(); }
  const std::vector<ArmSetPoint>& points() const noexcept { return points_; }

  /// Fast for times that go forward; `motion`: of the joints' size.
  void at(double time, std::vector<JointMotion>& motion) noexcept;

private:
  std::vector<ArmSetPoint> points_;
  std::size_t last_{};  // set point not after the time asked for last
};
}  // namespace hjt
