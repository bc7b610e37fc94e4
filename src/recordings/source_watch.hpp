// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Do several sources give the same joints in turn?
///
/// By the names of their nodes where these are recorded; else by the angles: a row far from its neighbours, which are
/// near to each other, and near to another such row shortly before, in more than LEAST_SHARE of the rows. Damage comes
/// once, and noise is small beside the motion.
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
    if (step > GROWN * counted_step_)  // the motion before was noise
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

  /// As a clause; empty: one source.
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
                         std::to_string(seen_) + " rows the angles jump to and fro" :
                     std::string();
  }

private:
  static constexpr double LEAST_STEP = 5e-3;      // beyond the noise of an angle [rad]
  static constexpr double LEAST_OF_RANGE = 1e-3;  // share of the sum of the joints' ranges: angles may be in degrees
  static constexpr double GROWN = 5.0;
  static constexpr double NEARER = 0.3;  // [-]
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

  /// Of all joints together, with these rows.
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
  std::array<std::vector<MotionRow>, 2> apart_;  // rows far from their neighbours
  std::uint64_t jumps_{};
  std::vector<double> least_;  // of the joints
  std::vector<double> most_;
  double counted_step_{ LEAST_STEP };  // of the first row that counts [rad]
  std::uint64_t seen_{};
  std::uint64_t moves_{};
  std::uint64_t returns_{};
};
}  // namespace hjt
