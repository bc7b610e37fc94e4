// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_load.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tracking/telemetry_rows.hpp"

namespace hjt
{
ArmRates::ArmRates(std::size_t joints)
  : times_(joints)
  , slow_(joints, MotionDifferentiator(HALF_WIDTH))
  , fast_(joints)
  , waiting_(ROOM,
             { std::vector<MotionSample>(joints), std::vector<MotionSample>(joints), std::vector<double>(joints) })
  , rows_(joints)
{
}

void ArmRates::reset() noexcept
{
  std::fill(slow_.begin(), slow_.end(), MotionDifferentiator(HALF_WIDTH));
  std::fill(fast_.begin(), fast_.end(), MotionDifferentiator());
  times_.reset();
  first_waiting_ = end_waiting_ = 0;
  last_time_ = -std::numeric_limits<double>::infinity();
}

bool ArmRates::push(const std::vector<MotionRow>& rows) noexcept
{
  const double time = rows.front().time;
  if (time < last_time_ - StreamTiming::RESTART)
  {
    reset();
  }
  // An impossible row of one joint drops the rows of all joints, so that all joints have rows of the same times.
  const bool is_plausible = std::all_of(
      rows.begin(), rows.end(), [](const MotionRow& row) { return isPlausible(row) && std::isfinite(row.load); });
  if (!is_plausible || time < last_time_ + MotionDifferentiator::MIN_STEP)
  {
    return false;
  }
  if (std::isinf(last_time_))
  {
    has_velocities_ = std::all_of(rows.begin(), rows.end(),
                                  [](const MotionRow& row) { return std::isfinite(row.recorded_velocity); });
  }
  last_time_ = time;
  rows_ = rows;
  if (has_velocities_)
  {
    pushFast();
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    slow_[i].push(rows_[i]);
  }
  return true;
}

/// Gives rows_, with the errors of their stamps, to fast_.
void ArmRates::pushFast() noexcept
{
  const double stamp_error = times_.stampError(rows_);
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    rows_[i].stamp_error = stamp_error;
    fast_[i].push(rows_[i]);
  }
}

/// Moves the next sample of every joint to `samples`. Returns false if the sample of a joint is not ready.
bool ArmRates::take(std::vector<MotionDifferentiator>& from, bool at_end, std::vector<MotionSample>& samples) noexcept
{
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    const std::optional<MotionSample> sample = from[i].pop(at_end);
    if (!sample)
    {
      return false;
    }
    samples[i] = *sample;
  }
  return true;
}

ArmSample* ArmRates::pop(bool at_end) noexcept
{
  while (end_waiting_ < first_waiting_ + ROOM)
  {
    ArmSample& slow = waiting_[end_waiting_ % ROOM];
    if (!take(slow_, at_end, slow.joints))
    {
      break;
    }
    ++end_waiting_;
    if (!has_velocities_)
    {
      for (std::size_t i = 0; i < rows_.size(); ++i)
      {
        rows_[i] = slow.joints[i];
        rows_[i].recorded_velocity = slow.joints[i].velocity;
      }
      pushFast();
    }
  }
  ArmSample& sample = waiting_[first_waiting_ % ROOM];
  if (first_waiting_ == end_waiting_ || !take(fast_, at_end, sample.own))
  {
    return nullptr;
  }
  ++first_waiting_;
  for (std::size_t i = 0; i < sample.own.size(); ++i)
  {
    sample.own[i].recorded_velocity = sample.joints[i].recorded_velocity;
  }
  return &sample;
}

LinkTorques::LinkTorques(const ArmDescription& arm, PayloadCourse course)
  : links_(arm), course_(std::move(course)), motion_(ArmDynamics(arm).joints()), fast_torques_(motion_.size())
{
}

/// Sets the payload that the arm carries at `time` by course_; before the first entry the payload of this entry.
void LinkTorques::carry(double time) noexcept
{
  const auto next = std::find_if(course_.begin(), course_.end(), [time](const auto& from) { return from.time > time; });
  const auto now = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - course_.begin(), 1) - 1);
  if (!course_.empty() && now != carried_)
  {
    links_.setPayload(course_[now].payload);
    carried_ = now;
  }
}

void LinkTorques::find(const std::vector<MotionSample>& samples, std::vector<double>& torques) noexcept
{
  for (std::size_t i = 0; i < motion_.size(); ++i)
  {
    motion_[i] = { samples[i].position, samples[i].velocity, samples[i].acceleration };
  }
  links_.own(motion_, torques);
}

void LinkTorques::addTo(ArmSample& sample) noexcept
{
  carry(sample.joints.front().time);
  find(sample.joints, sample.torques);
  find(sample.own, fast_torques_);
  for (std::size_t i = 0; i < motion_.size(); ++i)
  {
    sample.own[i].vibration = fast_torques_[i] - sample.torques[i];
  }
}
}  // namespace hjt
