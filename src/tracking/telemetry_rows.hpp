// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/stamp.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Largest time [s], angle [rad] and effort [A] or [N.m] in an undamaged message.
constexpr double MAX_TIME = 1e-9 * static_cast<double>(MAX_STAMP);
constexpr double MAX_ANGLE = 1.0e4;
constexpr double MAX_EFFORT = 1.0e4;

inline bool isPlausibleEffort(double effort) noexcept
{
  return std::abs(effort) <= MAX_EFFORT;  // false for NaN
}

/// Whether time, position, current and, if the row has one, motor angle of a row are possible values.
inline bool isPlausible(const MotionRow& row) noexcept
{
  return std::abs(row.time) < MAX_TIME && std::abs(row.position) < MAX_ANGLE && isPlausibleEffort(row.current) &&
         !(std::abs(row.motor_angle) > MAX_ANGLE * MAX_ANGLE);
}

/// Largest current that the motor of this joint can draw [A].
inline double possibleCurrent(const Parameters& parameters) noexcept
{
  constexpr double MARGIN = 3.0;  // largest current over the current of the motor's continuous torque [-]
  return MARGIN * parameters.motor.torque_limit * nominalRatio(parameters.gear) /
         parameters.telemetry.torque_per_current;
}

/// Timing of a stream of stamped rows. All times have the same zero.
struct StreamTimingReport
{
  std::uint64_t rows{};      ///< number of rows with a later stamp than the row before
  std::uint64_t repeated{};  ///< number of rows with the stamp of the row before
  std::uint64_t backward{};  ///< number of rows with an earlier stamp than the row before
  std::uint64_t missing{};   ///< number of rows that are missing in gaps between rows, by `period`
  double period{};           ///< median step between the stamps of the last rows [s]
  double longest_gap{};      ///< longest step between stamps [s]
  double offset{};           ///< least time from stamp to arrival: offset of the clocks + shortest transport [s]
  double jitter{};           ///< 95 % of the rows arrive within `offset` + `jitter` after their stamps [s]
};

/// Watches the stamps of a stream and the times when its rows arrive. The memory has a fixed size; nothing allocates.
class StreamTiming
{
public:
  /// Jump back of the stamps from which on a new stream begins, for example another recording [s].
  static constexpr double RESTART = 1.0;

  void reset() noexcept { *this = StreamTiming(); }

  void add(double time, double received) noexcept
  {
    if (time < last_ - RESTART)
    {
      reset();
    }
    if (time <= last_)
    {
      ++(time == last_ ? report_.repeated : report_.backward);
      return;
    }
    const double interval = report_.rows > 0 ? time - last_ : 0.0;
    const std::size_t slot = report_.rows % KEPT;
    // The first row has no interval, so the interval between first and second row stands for it.
    intervals_[slot] = interval;
    intervals_[0] = report_.rows == 1 ? interval : intervals_[0];
    delays_[slot] = received - time;
    last_ = time;
    ++report_.rows;
    if (report_.rows % RENEW == 0)
    {
      report_.period = quantile(intervals_, kept(), 0.5);
    }
    report_.longest_gap = std::max(report_.longest_gap, interval);
    if (report_.period > 0.0 && interval > 1.5 * report_.period)
    {
      report_.missing += static_cast<std::uint64_t>(std::lround(interval / report_.period)) - 1;
    }
  }

  StreamTimingReport report() const noexcept
  {
    StreamTimingReport report = report_;
    report.period = quantile(intervals_, kept(), 0.5);
    report.offset = quantile(delays_, kept(), 0.0);
    report.jitter = quantile(delays_, kept(), 0.95) - report.offset;
    return report;
  }

private:
  static constexpr std::size_t KEPT = 256;  // number of last rows from which quantiles are computed
  static constexpr std::size_t RENEW = 32;  // number of rows from one computation of the period to the next

  template <std::size_t N>
  static double quantile(std::array<double, N> values, std::size_t count, double part) noexcept
  {
    if (count == 0)
    {
      return 0.0;
    }
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(count - 1));
    std::nth_element(values.begin(), place, values.begin() + static_cast<std::ptrdiff_t>(count));
    return *place;
  }

  std::size_t kept() const noexcept { return report_.rows < KEPT ? static_cast<std::size_t>(report_.rows) : KEPT; }

  StreamTimingReport report_;
  std::array<double, KEPT> intervals_{};
  std::array<double, KEPT> delays_{};
  double last_{ -std::numeric_limits<double>::infinity() };
};

/// Makes the angles of a joint continuous if their source keeps the angles within one turn. Nothing allocates.
///
/// A change of the angle within MotionDifferentiator::MAX_GAP that differs from one turn by less than NEAR is a fold,
/// because no joint turns so far in this time. A change over a longer time is no fold.
class UnfoldedAngle
{
public:
  /// Returns the continuous angle for `angle` [rad] at `time` [s].
  double take(double time, double angle) noexcept
  {
    const double step = angle - last_;
    const double turns = std::round(step / (TWO_PI));
    const double passed = time - time_;
    if (std::abs(turns) == 1.0 && passed > 0.0 && passed <= MotionDifferentiator::MAX_GAP &&
        std::abs(step - TWO_PI * turns) < NEAR)
    {
      offset_ -= TWO_PI * turns;
      ++folds_;
    }
    last_ = angle;
    time_ = time;
    return offset_ == 0.0 ? angle : angle + offset_;
  }

  std::uint64_t folds() const noexcept { return folds_; }
  void reset() noexcept { *this = UnfoldedAngle(); }

private:
  static constexpr double NEAR = 1.0;  // largest difference between a fold and one turn [rad]

  double last_{ std::numeric_limits<double>::quiet_NaN() };
  double time_{ std::numeric_limits<double>::quiet_NaN() };
  double offset_{};
  std::uint64_t folds_{};
};

/// Numbers of rows that RowFilter dropped, for each reason.
struct LeftOutRows
{
  std::uint64_t impossible{};   ///< a value is not finite, or larger than in any undamaged message
  std::uint64_t unreachable{};  ///< an angle contradicts those of the rows before and after
  std::uint64_t repeated{};     ///< all values are those of the row before, although the joints move
  std::uint64_t bunched{};      ///< the row follows sooner than a quarter of the mean time between rows

  std::uint64_t all() const noexcept { return impossible + unreachable + repeated + bunched; }
};

/// Largest speed of a joint that its motor allows [rad/s].
inline double greatestSpeed(const Parameters& parameters) noexcept
{
  return parameters.motor.speed_limit / nominalRatio(parameters.gear);
}

/// Passes only rows that are new and possible, for several joints, from recordings, arrays or live messages.
///
/// The filter holds back a row with an angle that the joint cannot have reached since the row before. If a later row,
/// within MotionDifferentiator::MAX_GAP, can be reached from the row before, the filter drops the rows that it held
/// back. Otherwise the angles really jumped, or stamps or unit of the angles are wrong. The filter then passes all held
/// rows, because later checks report these errors. The first row also waits for the second one, because no row before
/// it can confirm it.
///
/// The filter drops a row that repeats the angles, currents and velocities of all joints while the joints move, because
/// it was not measured: a recorder was stuck, or a driver publishes more often than its robot measures. The filter
/// drops a row that follows within a quarter of the mean time between rows, because such a row was stamped when a
/// buffer was emptied. After construction nothing throws or allocates.
class RowFilter
{
public:
  static constexpr double SLACK = 0.02;  ///< allowed error of the time between rows; messages come in bursts [s]

  using Rows = std::vector<MotionRow>;

  /// @param speeds largest speed of each joint [rad/s]
  explicit RowFilter(std::vector<double> speeds)
    : speeds_(std::move(speeds)), last_(speeds_.size()), raw_(speeds_.size()), held_(ROOM, Rows(speeds_.size()))
  {
  }

  /// Forgets all rows, because rows of another stream follow.
  void reset() noexcept
  {
    has_last_ = has_raw_ = is_confirmed_ = moves_ = false;
    held_count_ = 0;
    rows_ = 0;
    mean_step_ = 0.0;
  }

  /// Takes one row of each joint, all of the same time. Calls `visit` with the rows that pass, in the order of their
  /// times. Returns false if `visit` returned false, that is if `visit` needs no more rows.
  template <class Visit>
  bool push(const Rows& rows, const Visit& visit)
  {
    if (!std::all_of(rows.begin(), rows.end(), [](const MotionRow& row) { return isPlausible(row); }))
    {
      ++left_out_.impossible;
      return true;
    }
    const double step = has_raw_ ? rows.front().time - raw_.front().time : 0.0;
    bool more = true;
    if (step < -StreamTiming::RESTART)
    {
      more = finish(visit);
      reset();
    }
    if (isRepeated(rows))
    {
      ++left_out_.repeated;
      return more;
    }
    if (isBunched(rows, step))
    {
      ++left_out_.bunched;
      return more;
    }
    return more && place(rows, visit);
  }

  /// Ends the stream: passes the first row if it still waits, and drops the rows that the filter holds back.
  template <class Visit>
  bool finish(const Visit& visit)
  {
    const bool waits = has_last_ && !is_confirmed_;
    is_confirmed_ = true;
    left_out_.unreachable += held_count_;
    held_count_ = 0;
    return !waits || visit(last_);
  }

  const LeftOutRows& leftOut() const noexcept { return left_out_; }

private:
  static constexpr std::size_t ROOM = 16;       // largest number of rows that the filter holds back
  static constexpr double MARGIN = 1.2;         // largest speed between rows over the greatest speed [-]
  static constexpr double MOVING = 0.01;        // least speed of a joint that moves [rad/s]
  static constexpr double BUNCHED = 0.25;       // time to a bunched row over the mean time between rows, at most [-]
  static constexpr double MEMORY = 64.0;        // number of rows over which mean_step_ is averaged
  static constexpr std::uint64_t SETTLED = 16;  // number of rows from which on the mean time between rows is known

  bool canReach(const Rows& from, const Rows& to) const noexcept
  {
    const double time = std::max(0.0, to.front().time - from.front().time) + SLACK;
    bool can = true;
    for (std::size_t i = 0; i < to.size(); ++i)
    {
      can = can && std::abs(to[i].position - from[i].position) <= MARGIN * speeds_[i] * time;
    }
    return can;
  }

  static bool isSame(double a, double b) noexcept { return a == b || (std::isnan(a) && std::isnan(b)); }

  bool isRepeated(const Rows& rows) noexcept
  {
    bool is_same = has_raw_ && rows.front().time > raw_.front().time;
    bool moves = false;
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      const MotionRow& now = rows[i];
      const MotionRow& before = raw_[i];
      is_same = is_same && now.position == before.position && now.current == before.current &&
                isSame(now.recorded_velocity, before.recorded_velocity);
      moves = moves || std::abs(now.recorded_velocity) > MOVING;
    }
    return is_same && (std::isfinite(rows.front().recorded_velocity) ? moves : moves_);
  }

  bool isBunched(const Rows& rows, double step) noexcept
  {
    if (has_raw_ && step > 0.0)
    {
      const double counted = std::min(step, MotionDifferentiator::MAX_GAP);
      ++rows_;
      mean_step_ += (counted - mean_step_) / std::min(static_cast<double>(rows_), MEMORY);
    }
    const double since = has_raw_ ? rows.front().time - kept_ : HUGE_VAL;
    const bool is_bunched = rows_ > SETTLED && since > 0.0 && since < BUNCHED * mean_step_;
    if (has_raw_ && step > 0.0)
    {
      moves_ = false;
      for (std::size_t i = 0; i < rows.size(); ++i)
      {
        moves_ = moves_ || std::abs(rows[i].position - raw_[i].position) > MOVING * step;
      }
    }
    std::copy(rows.begin(), rows.end(), raw_.begin());
    has_raw_ = true;
    kept_ = is_bunched ? kept_ : rows.front().time;
    return is_bunched;
  }

  template <class Visit>
  bool place(const Rows& rows, const Visit& visit)
  {
    if (!has_last_)
    {
      has_last_ = true;
      std::copy(rows.begin(), rows.end(), last_.begin());
      return true;
    }
    if (canReach(last_, rows))
    {
      left_out_.unreachable += held_count_;
      held_count_ = 0;
      return accept(rows, visit);
    }
    if (!is_confirmed_ && held_count_ > 0 && canReach(held_[held_count_ - 1], rows))
    {
      // The new row agrees with the held row, and both contradict the first row.
      ++left_out_.unreachable;
      is_confirmed_ = true;
      return release(visit) && accept(rows, visit);
    }
    if (held_count_ == ROOM || rows.front().time - last_.front().time > MotionDifferentiator::MAX_GAP)
    {
      return release(visit) && accept(rows, visit);
    }
    std::copy(rows.begin(), rows.end(), held_[held_count_++].begin());
    return true;
  }

  template <class Visit>
  bool accept(const Rows& rows, const Visit& visit)
  {
    const bool more = is_confirmed_ || visit(last_);
    is_confirmed_ = true;
    std::copy(rows.begin(), rows.end(), last_.begin());
    return more && visit(last_);
  }

  /// Passes the rows that the filter holds back to `visit`.
  template <class Visit>
  bool release(const Visit& visit)
  {
    bool more = true;
    for (std::size_t i = 0; i < held_count_ && more; ++i)
    {
      more = accept(held_[i], visit);
    }
    held_count_ = 0;
    return more;
  }

  std::vector<double> speeds_;
  Rows last_;               // the last rows that passed; the first rows of a stream wait here for the next
  Rows raw_;                // the last rows that push() received, without repeated rows
  std::vector<Rows> held_;  // the held rows, which the joints cannot have reached from last_
  std::size_t held_count_{};
  bool has_last_{};
  bool has_raw_{};
  bool is_confirmed_{};  // whether the rows in last_ have passed
  bool moves_{};         // whether the joints moved between the last two rows
  std::uint64_t rows_{};
  double mean_step_{};  // mean time between rows [s]
  double kept_{};       // time of the last row that was not bunched [s]
  LeftOutRows left_out_;
};
}  // namespace hjt
