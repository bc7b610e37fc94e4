// SPDX-License-Identifier: BSD-3-Clause
#include "arm/payload_watch.hpp"

namespace hjt
{
PayloadWatch::PayloadWatch(const ArmDescription& arm, const std::vector<Parameters>& joints) : arm_(arm)
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
    predicted_[i] = twins_[i].step(samples_[i]).current;
  }
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
  const IdentifiedPayload found = fit_->solve();
  next_look_ *= 2.0;
  if (next_look_ > PayloadFit::MOST_TIME)
  {
    reset();
  }
  constexpr double CLEARLY = 0.9;  // of the torques not predicted
  return found.isCarried() && found.residual_share < CLEARLY ? std::make_optional(found) : std::nullopt;
}
}  // namespace hjt
