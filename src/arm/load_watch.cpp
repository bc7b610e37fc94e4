// SPDX-License-Identifier: BSD-3-Clause
#include "arm/load_watch.hpp"

#include <limits>

namespace hjt
{
LoadWatch::LoadWatch(const ArmDescription& arm, const std::vector<Parameters>& joints)
  : arm_(arm), given_(arm.payload), given_gravity_(arm.gravity), counts_(joints.size(), true)
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
  fit_.emplace(arm_, gains_);
  last_time_ = -HUGE_VAL;
  next_look_ = FIRST_LOOK;
  is_new_ = true;
}

void LoadWatch::configure(const Payload& payload)
{
  arm_.payload = payload;
  reset();
}

void LoadWatch::mount(const std::array<double, 3>& gravity)
{
  arm_.gravity = gravity;
  reset();
}

void LoadWatch::add(const ArmSample& sample, bool touched)
{
  samples_ = sample.joints;
  for (std::size_t i = 0; i < samples_.size(); ++i)
  {
    samples_[i].load = sample.torques[i];
    samples_[i].after_gap = samples_[i].after_gap || is_new_;
    predicted_[i] = twins_[i].step(samples_[i]).current;
    if (!counts_[i])
    {
      samples_[i].current = std::numeric_limits<double>::quiet_NaN();
    }
  }
  is_new_ = false;
  if (samples_.front().time >= last_time_ + PERIOD)
  {
    last_time_ = samples_.front().time;
    fit_->add(samples_, predicted_, touched);
  }
}

std::optional<FoundLoad> LoadWatch::look()
{
  if (fit_->moved() < next_look_)
  {
    return std::nullopt;
  }
  const FoundLoad found = fit_->solve();
  next_look_ *= 2.0;
  if (next_look_ > LoadFit::MOST_TIME)
  {
    reset();
  }
  return found;
}

std::optional<IdentifiedMounting> LoadWatch::mountingOf(const FoundLoad& found) const
{
  if (!found.showsMounting())
  {
    return std::nullopt;
  }
  IdentifiedMounting named = found.mounting;
  named.configured = given_gravity_;
  named.gravity = named.differs() ? named.gravity : given_gravity_;
  return named;
}

std::optional<IdentifiedPayload> LoadWatch::payloadOf(const FoundLoad& found) const
{
  const IdentifiedPayload& payload = found.payload;
  const bool is_put_down = arm_.payload.mass > given_.mass && payload.differs() &&
                           payload.residual_share < FoundLoad::CLEARLY && !payload.isCarried();
  if (!found.showsPayload() && !is_put_down)
  {
    return std::nullopt;
  }
  IdentifiedPayload named = payload;
  named.configured = given_;
  return named;
}
}  // namespace hjt
