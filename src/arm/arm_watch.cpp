// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_watch.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <utility>

namespace hjt
{
bool ArmWatch::moves(const std::vector<MotionRow>& rows)
{
  constexpr double MOVED = 0.01;  // beyond play and noise [rad]
  constexpr double STILL = 1.0;   // [s]
  moved_from_.resize(rows.size(), HUGE_VAL);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    if (!(std::abs(rows[i].position - moved_from_[i]) < MOVED))
    {
      moved_from_[i] = rows[i].position;
      last_moved_ = rows[i].time;
    }
  }
  return rows.front().time < last_moved_ + STILL;
}

void ArmWatch::add(const std::vector<MotionRow>& rows)
{
  const double step = rows.front().time - last_time_;
  if (step < PERIOD || !moves(rows))
  {
    return;
  }
  last_time_ = rows.front().time;
  if (step > MotionDifferentiator::MAX_GAP)
  {
    return;  // no motion is seen over a gap
  }
  moved_ += step;
  if (moved_ >= 0.0 && moved_ <= ArmFit::ENOUGH)
  {
    rows_.push_back(rows);
  }
  if (moved_ >= next_look_ && !answer_.valid())
  {
    ask();
  }
}

void ArmWatch::ask()
{
  const bool is_last = moved_ >= ArmFit::ENOUGH;
  std::vector<std::vector<MotionRow>> rows;
  is_last ? rows.swap(rows_) : void(rows = rows_);
  moved_ = is_last ? -LoadFit::LAST_LOOK : moved_;
  next_look_ = is_last ? LoadFit::FIRST_LOOK : 2.0 * next_look_;
  is_stopped_ = false;
  answer_ = std::async(std::launch::async,
                       [this, rows = std::move(rows)]
                       {
                         const PlayArmRows play = [&](const VisitArmRows& visit)
                         {
                           for (std::size_t i = 0; i < rows.size() && !is_stopped_; ++i)
                           {
                             visit(rows[i]);
                           }
                         };
                         const std::vector<ArmCandidate> candidates = make_();
                         std::vector<std::string> names;
                         for (const ArmCandidate& candidate : candidates)
                         {
                           names.push_back(candidate.name);
                         }
                         const auto rank = [&](const std::vector<std::string>& of)
                         {
                           std::vector<ArmCandidate> chosen;
                           std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(chosen),
                                        [&](const ArmCandidate& candidate)
                                        { return std::find(of.begin(), of.end(), candidate.name) != of.end(); });
                           return rankArms(chosen, play, unit_is_given_);
                         };
                         return betterArm(own_, std::move(names), rank);
                       });
}

bool ArmWatch::look()
{
  if (!answer_.valid() || answer_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
  {
    return false;
  }
  if (is_stopped_)
  {
    answer_ = {};  // of rows of before
    return false;
  }
  other_ = answer_.get();
  is_settled_ = true;
  if (!other_.empty())
  {
    moved_ = std::max(moved_, 0.0);  // one that was wrong, as of an arm led by hand, does not last
  }
  return true;
}

void ArmWatch::reset()
{
  rows_.clear();
  moved_from_.clear();
  moved_ = 0.0;
  next_look_ = LoadFit::FIRST_LOOK;
  last_moved_ = last_time_ = -HUGE_VAL;
  other_.clear();
  is_settled_ = false;
  is_stopped_ = true;
}
}  // namespace hjt
