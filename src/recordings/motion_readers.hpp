// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harmonic_joint_twin/base/stamp.hpp"
#include "recordings/recorded_motion.hpp"
#include "tracking/motion_differentiator.hpp"
#include "tracking/telemetry_rows.hpp"

namespace hjt
{
/// Converts the stamps of a recording's rows to times since its first row [s].
///
/// A recording of a bag that was played in a loop has several rounds. The times of a new round begin BETWEEN after the
/// last time of the round before, a gap that divides the recording. A round begins if a stamp jumps back by more than
/// BACK, or ahead by more than AHEAD, as after stamps of a clock that was not set. A round also begins if more than
/// MOST_BEHIND rows in order are earlier than a row before them, as after a clock was set back by less than BACK. More
/// than MOST_AHEAD jumps ahead mean that the stamps have another unit; then a jump ahead begins no round.
class RowTime
{
public:
  /// Jump back that begins a round; a row that jumps back by less is out of order [s].
  static constexpr double BACK = 1.0;
  static constexpr double AHEAD = 86400.0;  ///< jump ahead that begins a round [s]
  static constexpr double BETWEEN = 1.0;    ///< time from the end of a round to the next [s]
  static constexpr std::uint64_t MOST_AHEAD = 10;
  static constexpr std::uint64_t MOST_BEHIND = 10;

  double at(Stamp stamp)
  {
    if (!last_)
    {
      last_ = stamp;
      zero_ = start_ = stamp;
    }
    const double step = toSeconds(stamp - *last_);
    ahead_ += step > AHEAD ? 1 : 0;
    behind_ = step > 0.0 && offset_ + toSeconds(stamp - zero_) < time_ ? behind_ + 1 : 0;
    if (step < -BACK || (step > AHEAD && ahead_ <= MOST_AHEAD) || behind_ > MOST_BEHIND)
    {
      zero_ = stamp;
      offset_ = time_ + BETWEEN;
      behind_ = 0;
      ++rounds_;
    }
    last_ = stamp;
    const double time = offset_ + toSeconds(stamp - zero_);
    time_ = time > time_ ? time : time_;
    return time;
  }

  /// Time at which the row that was last given to `at` was received [s]. `recorded`: stamp of the reception.
  double received(Stamp recorded) const { return offset_ + toSeconds(recorded - zero_); }

  std::uint64_t rounds() const { return rounds_; }
  Stamp start() const { return start_; }

private:
  std::optional<Stamp> last_;
  Stamp zero_{};
  Stamp start_{};
  double offset_{};
  double time_{};
  std::uint64_t rounds_{ 1 };
  std::uint64_t ahead_{};
  std::uint64_t behind_{};
};

/// Checks whether the rows come in the order of their stamps.
class RowOrder
{
public:
  void add(double stamp)
  {
    if (rows_++ > 0)
    {
      back_ += stamp < last_ ? 1 : 0;
      same_ += stamp == last_ ? 1 : 0;
    }
    last_ = stamp;
  }

  /// Clause on the wrong order of the rows; empty if nearly all rows are in order.
  std::string text() const
  {
    constexpr std::uint64_t FEWEST = 10;
    constexpr std::uint64_t MOST = 5;    // least mean number of rows for each row that goes back
    constexpr std::uint64_t COPIES = 9;  // largest mean number of rows with the same stamp
    if (rows_ < FEWEST)
    {
      return {};
    }
    if (same_ + 1 == rows_)
    {
      return "all rows have the same stamp: times, speeds and loads are unknown";
    }
    if (COPIES * same_ > (COPIES - 1) * rows_)
    {
      return "the stamps are rounded: " + std::to_string(same_) + " of " + std::to_string(rows_) +
             " rows have the stamp of the row before, so times, speeds and loads are unknown";
    }
    return MOST * back_ > rows_ ? "the rows are not in the order of their stamps: " + std::to_string(back_) + " of " +
                                      std::to_string(rows_) + " go back" :
                                  std::string();
  }

private:
  double last_{};
  std::uint64_t rows_{};
  std::uint64_t back_{};
  std::uint64_t same_{};
};

/// Detects several sources that publish the same joints in turn.
///
/// If the recording names the publishing nodes, messages of two nodes in turn show several sources. So do angles if, in
/// more than LEAST_SHARE of the moving rows, a row is far from its two neighbours, these neighbours are near to each
/// other, and one of the last rows of this kind is near to the row. A damaged row occurs only once; noise is small.
class SourceWatch
{
public:
  void add(const std::string& publisher, const std::vector<MotionRow>& rows)
  {
    if (!publisher.empty())
    {
      ++publishers_[publisher];
      switches_ += !last_publisher_.empty() && publisher != last_publisher_ ? 1 : 0;
      last_publisher_ = publisher;
    }
    const double step = std::max(LEAST_STEP, LEAST_OF_RANGE * rangeWith(rows));
    if (step > GROWN * counted_step_)  // the motion that was counted so far was noise
    {
      counted_step_ = step;
      moves_ = returns_ = 0;
    }
    if (seen_ >= 2)
    {
      const std::vector<MotionRow>& last = last_[(seen_ - 1) % 2];
      const double to_last = distance(rows, last);
      const double to_other = distance(rows, last_[seen_ % 2]);
      moves_ += to_last > step || to_other > step ? 1 : 0;
      if (to_last > step && to_other < NEARER * to_last)
      {
        const auto is_near = [&](const std::vector<MotionRow>& apart)
        { return !apart.empty() && distance(apart, last) < NEARER * to_last; };
        returns_ += std::any_of(apart_.begin(), apart_.end(), is_near) ? 1 : 0;
        apart_[jumps_++ % apart_.size()] = last;
      }
    }
    last_[seen_++ % 2] = rows;
  }

  /// Clause on several sources; empty if the recording has one source.
  std::string text() const
  {
    if (publishers_.size() > 1 && switches_ >= LEAST_RETURNS)
    {
      std::string names;
      for (const auto& [name, messages] : publishers_)
      {
        names += (names.empty() ? "" : " and ") + name;
      }
      return "several sources give these joints in turn on this topic: the nodes " + names;
    }
    const bool returns =
        returns_ >= LEAST_RETURNS && static_cast<double>(returns_) > LEAST_SHARE * static_cast<double>(moves_);
    return returns ? "two sources give these joints in turn on this topic: in " + std::to_string(returns_) + " of " +
                         std::to_string(seen_) + " rows the angles jump from one source to the other" :
                     std::string();
  }

private:
  // Least distance between rows of different sources: larger than the noise of an angle [rad].
  static constexpr double LEAST_STEP = 5e-3;
  // Least distance between rows of two sources over the sum of the joints' ranges [-]. Angles may be in degrees.
  static constexpr double LEAST_OF_RANGE = 1e-3;
  static constexpr double GROWN = 5.0;
  static constexpr double NEARER = 0.3;  // largest distance that counts as near, over a far distance [-]
  static constexpr double LEAST_SHARE = 0.05;
  static constexpr std::uint64_t LEAST_RETURNS = 20;

  static double distance(const std::vector<MotionRow>& a, const std::vector<MotionRow>& b)
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
      sum += std::abs(a[i].position - b[i].position);
    }
    return sum;
  }

  /// Sum of the ranges of the joints' angles in all rows, including these rows.
  double rangeWith(const std::vector<MotionRow>& rows)
  {
    constexpr double NONE = std::numeric_limits<double>::infinity();
    least_.resize(rows.size(), NONE);
    most_.resize(rows.size(), -NONE);
    double range = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      least_[i] = std::min(least_[i], rows[i].position);
      most_[i] = std::max(most_[i], rows[i].position);
      range += most_[i] - least_[i];
    }
    return range;
  }

  std::map<std::string, std::uint64_t> publishers_;
  std::string last_publisher_;
  std::uint64_t switches_{};
  std::array<std::vector<MotionRow>, 2> last_;
  std::array<std::vector<MotionRow>, 2> apart_;  // last rows that were far from their neighbours
  std::uint64_t jumps_{};
  std::vector<double> least_;  // least angle of each joint
  std::vector<double> most_;
  double counted_step_{ LEAST_STEP };  // least distance that counted as motion when the counting began [rad]
  std::uint64_t seen_{};
  std::uint64_t moves_{};
  std::uint64_t returns_{};
};

// Each of the next three functions reads one kind of recording for readMotion. Times of messages are not scaled.

/// Reads messages. `visit` gets one row for each of `names` at a time; all of these rows have the same time.
MotionCount readMessageMotion(const MotionSource& source, const std::vector<std::string>& names,
                              const VisitMotionRows& visit, const std::function<void(double)>& progress);

/// Reads a controller's table. If `joints` is 1, reads only MotionSource::csv_joint, else all six. Scales the times.
MotionCount readTableMotion(const MotionSource& source, std::size_t joints, const VisitMotionRows& visit,
                            const std::function<void(double)>& progress);

/// Reads rows of `joints` joints from MotionSource::rows. Times are scaled by MotionSource::time_scale.
MotionCount readArrayMotion(const MotionSource& source, std::size_t joints, const VisitMotionRows& visit,
                            const std::function<void(double)>& progress);

/// Adds remarks on angles that were folded into one turn, and on a recording that was played in a loop.
void remarkOnRounds(const std::vector<UnfoldedAngle>& angles, std::uint64_t rounds, MotionCount& count);

/// Remark on joints whose effort is never a number; empty if there are no such joints.
std::string silentText(const std::vector<std::string>& joints);

/// Remark on values that are not a number in many rows; empty if there are none. `missing`: number of these rows, by
/// the name of the value.
std::string missingText(const std::map<std::string, std::uint64_t>& missing, const MotionCount& count);

/// Whether the table has a load of the source's joint.
bool tableRecordsLoad(const MotionSource& source);
}  // namespace hjt
