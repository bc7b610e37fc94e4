// SPDX-License-Identifier: BSD-3-Clause
#include "health/health_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"

namespace hjt
{
namespace
{
constexpr int MARKS_PER_TOOTH = 16;
constexpr double MIN_TRAVEL = 1e-6;  // least travel of the output, as a share of its nominal travel [-]
// Farthest motor angle in marks, because larger doubles do not separate neighbouring marks.
constexpr double FARTHEST_PLACE = 1e15;
}  // namespace

TurnWindow::TurnWindow(const GearParameters& gear)
  : nominal_ratio_(nominalRatio(gear))
  , marks_per_turn_(MARKS_PER_TOOTH * gear.teeth_flexspline)
  , marks_per_radian_(static_cast<double>(marks_per_turn_) / TWO_PI)
  , torsions_(Eigen::VectorXd::Zero(marks_per_turn_ + 2))
{
}

void TurnWindow::reset() noexcept
{
  started_ = false;
  direction_ = 1;
  newest_ = 0;
  count_ = 0;
}

void TurnWindow::update(double motor_angle, double torsion) noexcept
{
  double place = direction_ * motor_angle * marks_per_radian_;
  if (!(std::abs(place) < FARTHEST_PLACE))
  {
    reset();
    return;
  }
  if (!started_)
  {
    started_ = true;
    newest_mark_ = static_cast<std::int64_t>(std::floor(place));
  }
  else if (place <= static_cast<double>(newest_mark_ - 1))
  {
    direction_ = -direction_;
    place = -place;
    place_ = -place_;
    newest_mark_ = static_cast<std::int64_t>(std::floor(place_));
    count_ = 0;
  }
  const auto mark = static_cast<std::int64_t>(std::floor(place));
  if (mark > newest_mark_)
  {
    const double slope = (torsion - torsion_) / (place - place_);
    const std::int64_t first = std::max(newest_mark_ + 1, mark - marks_per_turn_ - 1);
    keep(static_cast<double>(first) - place_, slope, mark - first + 1);
    newest_mark_ = mark;
  }
  place_ = place;
  torsion_ = torsion;
}

Indicator TurnWindow::transmissionRatio() const noexcept
{
  if (!full())
  {
    return {};
  }
  const double back = static_cast<double>(newest_mark_ + marks_per_turn_) - place_;
  const auto later = static_cast<Eigen::Index>(std::floor(back));
  const double share = back - static_cast<double>(later);
  const double torsion_then = (1.0 - share) * torsionAt(later) + share * torsionAt(later + 1);
  const double motor_travel = direction_ * TWO_PI;
  const double output_travel = motor_travel / nominal_ratio_ - (torsion_ - torsion_then);
  if (std::abs(output_travel) < MIN_TRAVEL * TWO_PI / nominal_ratio_)
  {
    return {};
  }
  return { true, motor_travel / output_travel };
}

Indicator TurnWindow::kinematicError() const noexcept
{
  if (!full())
  {
    return {};
  }
  const double end = torsionAt(0);
  const double slope = (end - torsionAt(marks_per_turn_)) / static_cast<double>(marks_per_turn_);
  double lowest = 0.0;  // the ends of the turn lie on the line
  double highest = 0.0;
  const auto widen = [&](Eigen::Index first, Eigen::Index count, Eigen::Index newest)
  {
    const double start = end + slope * static_cast<double>(first - newest);
    const auto line = Eigen::VectorXd::LinSpaced(count, start, start + slope * static_cast<double>(count - 1));
    const auto errors = torsions_.segment(first, count) - line;
    lowest = std::min(lowest, errors.minCoeff());
    highest = std::max(highest, errors.maxCoeff());
  };
  // The marks of the last turn are two contiguous pieces of the ring buffer, with one older mark between the pieces.
  const Eigen::Index size = torsions_.size();
  const Eigen::Index first = newest_ + 1 == size ? 1 : 0;
  widen(first, newest_ + 1 - first, newest_);
  if (newest_ + 2 < size)
  {
    widen(newest_ + 2, size - newest_ - 2, newest_ + size);
  }
  return { true, highest - lowest };
}

/// Stores the torsion at the next `marks` marks, extrapolated from the last sample with `slope` [rad per mark]. The
/// first mark is `place` marks after the last sample.
void TurnWindow::keep(double place, double slope, std::int64_t marks) noexcept
{
  count_ = std::min<Eigen::Index>(count_ + marks, torsions_.size());
  while (marks > 0)
  {
    const Eigen::Index next = newest_ + 1 == torsions_.size() ? 0 : newest_ + 1;
    const auto run = static_cast<int>(std::min<Eigen::Index>(marks, torsions_.size() - next));
    double* kept = torsions_.data() + next;
#pragma omp simd
    for (int i = 0; i < run; ++i)
    {
      kept[i] = torsion_ + slope * (place + i);
    }
    newest_ = next + run - 1;
    place += run;
    marks -= run;
  }
}

double TurnWindow::torsionAt(Eigen::Index marks_back) const noexcept
{
  return torsions_[newest_ >= marks_back ? newest_ - marks_back : newest_ + torsions_.size() - marks_back];
}
}  // namespace hjt
