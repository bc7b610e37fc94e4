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
/// One row of a robot's telemetry, of one joint.
struct MotionRow
{
  double time{};      ///< time of the row [s]
  double position{};  ///< angle of the joint [rad]
  double current{};   ///< current of the motor [A]
  double load{};      ///< load at the output, > 0 resists positive motion [N.m]
  double motor_angle{ std::numeric_limits<double>::quiet_NaN() };        ///< motor angle; NaN: not measured [rad]
  double recorded_velocity{ std::numeric_limits<double>::quiet_NaN() };  ///< recorded speed; NaN: not recorded [rad/s]
  double received{};     ///< time of arrival, from the same zero as `time` [s]
  double stamp_error{};  ///< delay of `time` behind the motion [s]
  /// Torque of the links' vibration at the output, which `load` does not include [N.m].
  double vibration{};
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

/// A row with its rates.
struct MotionSample : MotionRow
{
  double velocity{};      ///< speed of the joint [rad/s]
  double acceleration{};  ///< acceleration of the joint [rad/s^2]
  bool after_gap{};       ///< this sample is the first one after a gap
};

/// Speed and acceleration from a stream of angles whose rows may come unevenly, twice or not at all.
///
/// For each row a parabola is fitted by least squares to the rows within a half width of it, but to two rows on either
/// side at least, with the true times of the rows. A sample comes out when the rows after it are known, which is the
/// half width or two rows later at most. Memory is fixed; nothing allocates.
class MotionDifferentiator
{
public:
  static constexpr double HALF_WIDTH = 0.036;  ///< best for the currents of a UR5 (docs/arm.md) [s]
  static constexpr double MAX_GAP = 0.1;       ///< longer gaps cut the stream [s]
  static constexpr double MIN_STEP = 0.5e-3;   ///< rows that follow sooner are left out [s]
  static constexpr double MOVING = 0.02;       ///< slower speeds may be noise of the angles [rad/s]
  static constexpr double SLIDING = 0.05;      ///< slower motion shows little of friction and load [rad/s]

  /// @param half_width up to 0.12 [s]
  explicit MotionDifferentiator(double half_width = HALF_WIDTH) noexcept : half_width_(half_width) {}

  /// False: the row is not later than the row before, or not finite, and is left out.
  bool push(const MotionRow& row) noexcept;

  /// The next sample that is ready, with `at_end` also samples that wait for later rows. Call it until it returns none.
  std::optional<MotionSample> pop(bool at_end = false) noexcept;

  std::uint64_t refused() const noexcept { return refused_; }  ///< rows left out by `push`
  std::uint64_t gaps() const noexcept { return segment_; }

private:
  /// Values of a row that a fit uses.
  struct Point
  {
    double time{};            // true [s]
    double position{};        // [rad]
    std::uint64_t segment{};  // number of gaps before it
  };
  static constexpr std::size_t ROOM = 512;      // holds two windows of rows at MIN_STEP
  static constexpr int MIN_ROWS = 4;            // a parabola passes through any three rows exactly
  static constexpr std::uint64_t MIN_SIDE = 2;  // rows to either side, however far apart

  const Point& at(std::uint64_t index) const noexcept { return points_[index % ROOM]; }
  MotionSample fit(std::uint64_t index) const noexcept;

  double half_width_;
  std::array<MotionRow, ROOM> rows_{};
  std::array<Point, ROOM> points_{};
  std::uint64_t next_{};  // number of the next row to come out
  std::uint64_t end_{};   // number after the last row
  std::uint64_t segment_{};
  std::uint64_t refused_{};
};
}  // namespace hjt
