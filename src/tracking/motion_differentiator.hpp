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
  double time{};                                                   ///< [s]
  double position{};                                               ///< of the joint [rad]
  double current{};                                                ///< of the motor [A]
  double load{};                                                   ///< at the output, > 0 resists positive motion [N.m]
  double motor_angle{ std::numeric_limits<double>::quiet_NaN() };  ///< NaN: not measured [rad]
  double recorded_velocity{ std::numeric_limits<double>::quiet_NaN() };  ///< NaN: not recorded [rad/s]
  double received{};                                                     ///< when it arrived, from the same zero [s]
  double stamp_error{};                                                  ///< delay of `time` behind the motion [s]
  /// At the output, of the links' vibration, which the load leaves out [N.m].
  double vibration{};
  double temperature{ std::numeric_limits<double>::quiet_NaN() };  ///< of the drive; NaN: not measured [degC]
  /// Motor current that the controller expects in this motion; NaN: not recorded [A].
  double target_current{ std::numeric_limits<double>::quiet_NaN() };

  double temperatureOr(double configured) const noexcept
  {
    return std::isfinite(temperature) ? temperature : configured;
  }
};

/// The same with its rates.
struct MotionSample : MotionRow
{
  double velocity{};      ///< [rad/s]
  double acceleration{};  ///< [rad/s^2]
  bool after_gap{};       ///< first after a gap: the state before is discarded
};

/// Speed and acceleration from a stream of angles whose rows may come unevenly, twice or not at all.
///
/// A parabola is laid through the rows within a half width of each, and two to either side at least, by least squares,
/// the true times of the rows counting. A sample comes out when the rows after it are known, so at most the half width
/// or two rows late. Memory is fixed; nothing allocates.
class MotionDifferentiator
{
public:
  static constexpr double HALF_WIDTH = 0.036;  ///< best for the currents of a UR5 (docs/arm.md) [s]
  static constexpr double MAX_GAP = 0.1;       ///< longer ones cut the stream [s]
  static constexpr double MIN_STEP = 0.5e-3;   ///< rows that follow sooner tell nothing new [s]
  static constexpr double MOVING = 0.02;       ///< slower ones are the noise of a slope [rad/s]
  static constexpr double SLIDING = 0.05;      ///< slower ones tell little of friction and load [rad/s]

  /// @param half_width up to 0.12 [s]
  explicit MotionDifferentiator(double half_width = HALF_WIDTH) noexcept : half_width_(half_width) {}

  /// False: the row is not later than the one before, or not finite, and is left out.
  bool push(const MotionRow& row) noexcept;

  /// The next sample that is ready; with `at_end` also those that wait for later rows. Call it until it has none.
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
  static constexpr int MIN_ROWS = 4;            // rows for a parabola that does not only pass through them
  static constexpr std::uint64_t MIN_SIDE = 2;  // rows to either side, however far apart

  const Point& at(std::uint64_t index) const noexcept { return points_[index % ROOM]; }
  MotionSample fit(std::uint64_t index) const noexcept;

  double half_width_;
  std::array<MotionRow, ROOM> rows_{};
  std::array<Point, ROOM> points_{};
  std::uint64_t next_{};  // next to come out
  std::uint64_t end_{};   // one past the last
  std::uint64_t segment_{};
  std::uint64_t refused_{};
};
}  // namespace hjt
