// SPDX-License-Identifier: BSD-3-Clause
#include "health/torsion_loop_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
constexpr int COLUMNS = 3;
constexpr int SLOPE = 2;           // column of the torque
constexpr double MAX_ERROR = 0.1;  // of the slope, standard, as a share of it [-]
constexpr std::size_t RISING = 0;
constexpr std::size_t FALLING = 1;
}  // namespace

TorsionLoopEstimate::TorsionLoopEstimate(const HealthParameters& health, const IndicatorParameters& parameters)
  : torque_range_(parameters.stiffness_torque)
  , torque_span_(health.stiffness_torque_span)
  , lost_motion_torque_(parameters.lost_motion_torque)
  , regression_(COLUMNS, 1)
{
  reset();
}

void TorsionLoopEstimate::reset() noexcept
{
  regression_.reset();
  lowest_ = 0.0;
  highest_ = 0.0;
  stiffness_ = {};
  lost_motion_ = {};
  branches_ = {};
  started_ = false;
  area_ = 0.0;
  loops_ = 0;
}

void TorsionLoopEstimate::add(double torsion, double joint_torque, double direction) noexcept
{
  followTorque(torsion, joint_torque);
  if (std::abs(joint_torque) < torque_range_)
  {
    const bool first = regression_.weight() == 0.0;
    lowest_ = first ? joint_torque : std::min(lowest_, joint_torque);
    highest_ = first ? joint_torque : std::max(highest_, joint_torque);
    regression_.add(Eigen::Vector3d(1.0, direction, joint_torque), Eigen::Matrix<double, 1, 1>(torsion));
  }
}

void TorsionLoopEstimate::followTorque(double torsion, double joint_torque) noexcept
{
  if (!started_)
  {
    started_ = true;
    rising_ = true;
    past_first_ = false;
    extreme_ = joint_torque;
    work_ = 0.0;
  }
  else
  {
    work_ += 0.5 * (joint_torque + torque_) * (torsion - torsion_);
  }
  torsion_ = torsion;
  torque_ = joint_torque;
  extreme_ = rising_ ? std::max(extreme_, joint_torque) : std::min(extreme_, joint_torque);
  if (std::abs(joint_torque - extreme_) > lost_motion_torque_)
  {
    // Seen as late after each maximum, so that what a loop is short of at its start it has more at its end.
    if (rising_)
    {
      area_ += past_first_ ? work_ : 0.0;
      loops_ += past_first_ ? 1 : 0;
      past_first_ = true;
      work_ = 0.0;
    }
    rising_ = !rising_;
    extreme_ = joint_torque;
  }
  if (past_first_ && std::abs(joint_torque) < lost_motion_torque_)
  {
    Branch& branch = branches_[rising_ ? RISING : FALLING];
    branch.count += 1.0;
    branch.torsion += torsion;
    branch.torque += joint_torque;
  }
}

void TorsionLoopEstimate::fit() noexcept
{
  stiffness_ = {};
  lost_motion_ = {};
  if (highest_ - lowest_ < torque_span_ || !regression_.fit(COLUMNS))
  {
    return;
  }
  const double slope = regression_.coefficient(SLOPE, 0);
  if (!(slope > 0.0) || regression_.standardError(SLOPE, 0) > MAX_ERROR * slope)
  {
    return;
  }
  stiffness_ = { true, 1.0 / slope };
  const Branch& rising = branches_[RISING];
  const Branch& falling = branches_[FALLING];
  if (rising.count > 0.0 && falling.count > 0.0)
  {
    const auto offset = [slope](const Branch& branch)
    { return (branch.torsion - slope * branch.torque) / branch.count; };
    lost_motion_ = { true, offset(falling) - offset(rising) };
  }
}

Indicator TorsionLoopEstimate::loopArea() const noexcept
{
  return loops_ > 0 ? Indicator{ true, area_ / loops_ } : Indicator{};
}
}  // namespace hjt
