// SPDX-License-Identifier: BSD-3-Clause
#include "arm/load_watch.hpp"

namespace hjt
{
LoadWatch::LoadWatch(const ArmDescription& arm, const std::vector<Parameters>& joints) : given_(arm), arm_(arm)
{
  for (const Parameters& joint : joints)
  {
    gains_.push_back(joint.telemetry.torque_per_current);
    twins_.emplace_back(joint);
  }
  predicted_.resize(joints.size());
  reset();
}

void LoadWatch::reset()
{
  start(isTrying() ? TRIAL : FIRST_LOOK);
}

void LoadWatch::start(double first_look)
{
  fit_.emplace(arm_, gains_);
  last_time_ = -HUGE_VAL;
  next_look_ = first_look;
  is_new_ = true;
}

void LoadWatch::add(const ArmSample& sample, bool touched)
{
  samples_ = sample.joints;
  for (std::size_t i = 0; i < samples_.size(); ++i)
  {
    samples_[i].load = sample.torques[i];
    samples_[i].after_gap = samples_[i].after_gap || is_new_;
    predicted_[i] = twins_[i].step(samples_[i]).current;
  }
  is_new_ = false;
  if (samples_.front().time >= last_time_ + PERIOD)
  {
    last_time_ = samples_.front().time;
    fit_->add(samples_, predicted_, touched);
  }
}

bool LoadWatch::look(const JudgedJoints& joints)
{
  const bool was_trying = isTrying();
  const bool is_other = law_.take(fit_->solve(joints.measured, LoadFit::Part::LAST), joints);
  has_looked_ = true;
  if (is_other)
  {
    arm_ = given_;
    law_.counts().configure(arm_);
  }
  next_look_ += FIRST_LOOK;
  if (is_other || was_trying || next_look_ > LAST_LOOK)
  {
    start(isTrying() ? TRIAL : was_trying && is_other ? LAST_LOOK : FIRST_LOOK);
  }
  return is_other;
}
}  // namespace hjt
