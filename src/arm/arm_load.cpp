// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_load.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tracking/plausible.hpp"

namespace hjt
{
ArmLoad::ArmLoad(const ArmDescription& arm)
  : dynamics_(arm)
  , differentiators_(dynamics_.joints(), MotionDifferentiator(HALF_WIDTH))
  , sample_{ std::vector<MotionSample>(dynamics_.joints()), std::vector<double>(dynamics_.joints()) }
  , motion_(dynamics_.joints())
{
}

void ArmLoad::reset() noexcept
{
  std::fill(differentiators_.begin(), differentiators_.end(), MotionDifferentiator(HALF_WIDTH));
  last_time_ = -std::numeric_limits<double>::infinity();
}

bool ArmLoad::push(const std::vector<MotionRow>& rows) noexcept
{
  const double time = rows.front().time;
  if (time < last_time_ - RESTART)
  {
    reset();
  }
  // Refused for one joint is refused for all: their rows stay side by side.
  const bool is_plausible = std::all_of(
      rows.begin(), rows.end(), [](const MotionRow& row) { return isPlausible(row) && std::isfinite(row.load); });
  if (!is_plausible || time < last_time_ + MotionDifferentiator::MIN_STEP)
  {
    return false;
  }
  last_time_ = time;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    differentiators_[i].push(rows[i]);
  }
  return true;
}

const ArmSample* ArmLoad::pop(bool at_end) noexcept
{
  for (std::size_t i = 0; i < motion_.size(); ++i)
  {
    const std::optional<MotionSample> sample = differentiators_[i].pop(at_end);
    if (!sample)
    {
      return nullptr;
    }
    sample_.joints[i] = *sample;
    motion_[i] = { sample->position, sample->velocity, sample->acceleration };
  }
  dynamics_.torques(motion_, sample_.torques);
  return &sample_;
}
}  // namespace hjt
