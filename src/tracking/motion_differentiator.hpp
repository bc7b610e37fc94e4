// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace hjt
{
/// One row of a robot's telemetry for one joint.
struct MotionRow
{
  double time{};      ///< time of the row [s]
  double position{};  ///< angle of the joint [rad]
  double current{};   ///< current of the motor [A]
  double load{};      ///< load at the output; > 0 resists positive motion [N.m]
  double motor_angle{ std::numeric_limits<double>::quiet_NaN() };        ///< motor angle; NaN: not measured [rad]
  double recorded_velocity{ std::numeric_limits<double>::quiet_NaN() };  ///< recorded speed; NaN: not recorded [rad/s]
  double received{};     ///< time of arrival, with the same zero as `time` [s]
  double stamp_error{};  ///< `time` - time of the angles and the current [s]
  double vibration{};    ///< torque at the output by the vibration of the links, which `load` does not contain [N.m]
  double temperature{
    std::numeric_limits<double>::quiet_NaN()
  };  ///< temperature of the drive; NaN: not measured [degC]
  /// Motor current that the controller expects in this motion; NaN: not recorded [A].
  double target_current{ std::numeric_limits<double>::quiet_NaN() };

  double temperatureOr(double configured) const noexcept
  {
    return std::isfinite(temperature) ? temperature : configured;
  }
};

/// A row with the speed and the acceleration of the joint.
struct MotionSample : MotionRow
{
  double velocity{};      ///< speed of the joint [rad/s]
  double acceleration{};  ///< acceleration of the joint [rad/s^2]
  bool after_gap{};       ///< whether this sample is the first one after a gap
};

/// Computes speed and acceleration from a stream of angles. Rows may be uneven in time, repeated or missing.
///
/// For each row the class fits a parabola by least squares to the rows within the half width before and after this row,
/// and to at least two rows on each side. The fit corrects the times of the rows by MotionRow::stamp_error. A sample is
/// ready when the rows after it are known, that is after the half width and after two rows. Nothing allocates.
class MotionDifferentiator
{
public:
  static constexpr double HALF_WIDTH = 0.036;  ///< half width that suits the currents of a UR5 best (docs/arm.md) [s]
  static constexpr double MAX_GAP = 0.1;       ///< longest time between rows that is no gap [s]
  static constexpr double MIN_STEP = 0.5e-3;   ///< least time between rows; push() drops a row that follows sooner [s]
  static constexpr double MOVING = 0.02;       ///< speed below which a motion may only be noise of the angles [rad/s]
  static constexpr double SLIDING = 0.05;  ///< speed below which the motion shows little of friction and load [rad/s]

  /// `half_width`: half width of the window of a fit, at most 0.12 [s].
  explicit MotionDifferentiator(double half_width = HALF_WIDTH) noexcept : half_width_(half_width) {}

  /// Takes a row. Returns false and drops the row if it is not later than the row before by MIN_STEP, or is not finite.
  bool push(const MotionRow& row) noexcept;

  /// The next sample that is ready, with `at_end` also a sample that waits for later rows; none: no sample is left.
  /// Call this function until it returns none.
  std::optional<MotionSample> pop(bool at_end = false) noexcept;

  std::uint64_t refused() const noexcept { return refused_; }  ///< number of rows that push() dropped
  std::uint64_t gaps() const noexcept { return segment_; }

private:
  /// The values of a row that the fit uses.
  struct Point
  {
    double time{};            // MotionRow::time - stamp_error [s]
    double position{};        // angle of the joint [rad]
    std::uint64_t segment{};  // number of gaps before the row
  };
  static constexpr std::size_t ROOM = 512;  // number of held rows; enough for two windows of rows at MIN_STEP
  static constexpr int MIN_ROWS = 4;  // least number of rows of a fit; a parabola passes exactly through three rows
  static constexpr std::uint64_t MIN_SIDE = 2;  // number of rows on each side that a fit uses at any distance

  const Point& at(std::uint64_t index) const noexcept { return points_[index % ROOM]; }
  MotionSample fit(std::uint64_t index) const noexcept;

  double half_width_;
  std::array<MotionRow, ROOM> rows_{};
  std::array<Point, ROOM> points_{};
  std::uint64_t next_{};  // number of the next row that becomes a sample
  std::uint64_t end_{};   // number after that of the last row
  std::uint64_t segment_{};
  std::uint64_t refused_{};
};
}  // namespace hjt
