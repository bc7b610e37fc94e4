// SPDX-License-Identifier: BSD-3-Clause
#include "arm/payload_watch.hpp"

#include <limits>

namespace hjt
{
PayloadWatch::PayloadWatch(const ArmDescription& arm, const std::vector<Parameters>& joints)
  : arm_(arm), given_(arm.payload), counts_(joints.size(), true)
{
  for (const Parameters& joint : joints)
  {
    gains_.push_back(joint.telemetry.torque_per_current);
    twins_.emplace_back(joint);
  }
  predicted_.resize(joints.size());
  reset();
}

void PayloadWatch::reset()
{
  fit_.emplace(arm_, gains_);
  last_time_ = -HUGE_VAL;
  next_look_ = FIRST_LOOK;
  leaveOut();
}

void PayloadWatch::configure(const Payload& payload)
{
  arm_.payload = payload;
  reset();
}

void PayloadWatch::add(const ArmSample& sample)
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
    fit_->add(samples_, predicted_);
  }
}

std::optional<IdentifiedPayload> PayloadWatch::look()
{
  if (fit_->moved() < next_look_)
  {
    return std::nullopt;
  }
  IdentifiedPayload found = fit_->solve();
  next_look_ *= 2.0;
  if (next_look_ > PayloadFit::MOST_TIME)
  {
    reset();
  }
  constexpr double CLEARLY = 0.9;  // of the torques not predicted
  const bool is_put_down = arm_.payload.mass > given_.mass && found.differs();
  const bool is_found = (found.isCarried() || is_put_down) && found.residual_share < CLEARLY;
  found.configured = given_;
  return is_found ? std::make_optional(found) : std::nullopt;
}
}  // namespace hjt
