// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_watch.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <system_error>
#include <utility>

namespace hjt
{
LoadWatch::LoadWatch(const ArmDescription& arm, const std::vector<Parameters>& joints,
                     std::vector<LoadFit::Drive> drives)
  : given_(arm), arm_(arm), drives_(std::move(drives))
{
  for (const Parameters& joint : joints)
  {
    twins_.emplace_back(joint);
  }
  reset();
}

void LoadWatch::reset()
{
  start(isTrying() ? TRIAL : LoadFit::FIRST_LOOK);
  frictions_.clear();
  is_of_others_ = isLooking();
}

void LoadWatch::start(double first_look)
{
  fit_.emplace(arm_, drives_);
  last_time_ = -HUGE_VAL;
  next_look_ = first_look;
  is_new_ = true;
}

void LoadWatch::add(const ArmSample& sample)
{
  const double time = sample.joints.front().time;
  const bool counts = time >= last_time_ + LoadFit::PERIOD;
  samples_ = sample.joints;
  for (std::size_t i = 0; i < samples_.size(); ++i)
  {
    samples_[i].load = sample.torques[i];
    samples_[i].after_gap = samples_[i].after_gap || is_new_;
    twins_[i].move(samples_[i]);
    if (counts)
    {
      twins_[i].bear(samples_[i]);
    }
  }
  is_new_ = false;
  if (counts)
  {
    last_time_ = time;
    fit_->add(samples_, [this](std::size_t i) -> const MotionDriven& { return twins_[i]; });
  }
}

bool LoadWatch::isDue() const
{
  return isLooking() ? found_.wait_for(std::chrono::seconds(0)) == std::future_status::ready :
                       fit_->moved() >= next_look_;
}

/// Starts a thread that evaluates the rows so far. If no thread can start, the next try is after 30 s more of motion.
void LoadWatch::begin(std::vector<bool> measured)
{
  looked_at_ = last_time_;
  try
  {
    found_ = std::async(std::launch::async,
                        [fit = *fit_, measured = std::move(measured)]() mutable { return fit.solve(measured); });
  }
  catch (const std::system_error&)
  {
    next_look_ += LoadFit::FIRST_LOOK;
  }
}

bool LoadWatch::look(const JudgedJoints& joints)
{
  if (isTrying())
  {
    return take({}, joints);
  }
  if (!isLooking())
  {
    begin(joints.measured);
    return false;
  }
  const FoundLoad found = found_.get();
  const bool counts = !is_of_others_;
  is_of_others_ = false;
  return counts && take(found, joints);
}

/// Takes the result of an evaluation or, while a load is on trial, that of the trial. `found`: load by the evaluation,
/// not used during a trial. Returns as look().
bool LoadWatch::take(const FoundLoad& found, const JudgedJoints& joints)
{
  const bool was_trying = isTrying();
  frictions_ = was_trying ? frictions_ : found.frictions;
  const bool alternates = found.changes.size() > 2 && found.changes.back().time > looked_at_ - LoadFit::FIRST_LOOK;
  misfit_ = alternates ? Misfit{ Reason::LOAD_WRONG,
                                 "the payload changes from leg to leg, as in picking and placing. "
                                 "`joint_twin compare` judges each leg of a recording with its payload" } :
                         found.misfit();
  const bool is_other = !alternates && law_.take(found.last(), joints);
  has_looked_ = true;
  if (is_other)
  {
    arm_ = given_;
    law_.counts().configure(arm_);
  }
  next_look_ += LoadFit::FIRST_LOOK;
  if (is_other || was_trying || next_look_ > LoadFit::LAST_LOOK)
  {
    start(isTrying() ? TRIAL : was_trying && is_other ? LoadFit::LAST_LOOK : LoadFit::FIRST_LOOK);
  }
  return is_other;
}

bool ArmWatch::moves(const std::vector<MotionRow>& rows)
{
  constexpr double MOVED = 0.01;  // least change of an angle that counts as motion; play and noise make less [rad]
  constexpr double STILL = 1.0;   // time after the last change of an angle that still counts as motion [s]
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
    return;  // a motion across a gap does not count
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
    answer_ = {};  // drops the result, because its rows are from before the last reset
    return false;
  }
  other_ = answer_.get();
  is_settled_ = true;
  if (!other_.empty())
  {
    moved_ = std::max(moved_, 0.0);  // rank again soon, because a hand that guides the arm can cause a wrong result
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
