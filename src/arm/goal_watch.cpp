// SPDX-License-Identifier: BSD-3-Clause
#include "arm/goal_watch.hpp"

#include <utility>

#include "base/publish_period.hpp"

namespace hjt
{
GoalWatch::GoalWatch(const ArmDescription& arm, const ArmTwin& twin)
  : period_(publishPeriod(arm.state_rate, twin.drive(0).parameters().solver.rate))
{
  report_.wanted.resize(twin.joints());
  report_.actual.resize(twin.joints());
}

void GoalWatch::begin(ArmGoal& goal) noexcept
{
  std::swap(goal_, goal);
  report_.number = goal_.number;
  report_.state = goal_.path.empty() ? GoalState::NONE : GoalState::UNDER_WAY;
}

void GoalWatch::forget() noexcept
{
  report_.state = report_.state == GoalState::UNDER_WAY ? GoalState::FORGOTTEN : report_.state;
}

void GoalWatch::look(MovingArm& arm) noexcept
{
  if (report_.state != GoalState::UNDER_WAY || arm.twin().stamp() % period_ != 0)
  {
    return;
  }
  report_.stamp = arm.twin().stamp();
  arm.wanted(report_.wanted);
  for (std::size_t i = 0; i < report_.actual.size(); ++i)
  {
    const JointReading reading = arm.reading(i);
    report_.actual[i] = { reading.position, reading.velocity, 0.0 };
  }
  const double left = arm.commandLeft();
  if (arm.protectiveStop())
  {
    report_.state = GoalState::STOPPED;
  }
  else if (left > 0.0)
  {
    report_.state = isBeyond(goal_.path) ? GoalState::OFF_PATH : GoalState::UNDER_WAY;
  }
  else if (!isBeyond(goal_.end))
  {
    report_.state = GoalState::REACHED;
  }
  else if (-left > goal_.patience)
  {
    report_.state = GoalState::NOT_THERE;
  }
}

/// The first joint that is, in the report.
bool GoalWatch::isBeyond(const std::vector<JointTolerance>& tolerances) noexcept
{
  for (std::size_t i = 0; i < tolerances.size(); ++i)
  {
    const JointMotion& wanted = report_.wanted[i];
    const JointMotion& actual = report_.actual[i];
    const double angle = std::abs(wanted.position - actual.position);
    const double speed = std::abs(wanted.velocity - actual.velocity);
    // Written so that NaN is beyond.
    report_.is_speed = angle <= tolerances[i].position;
    if (!report_.is_speed || !(speed <= tolerances[i].velocity))
    {
      report_.joint = i;
      report_.error = report_.is_speed ? speed : angle;
      report_.tolerance = report_.is_speed ? tolerances[i].velocity : tolerances[i].position;
      return true;
    }
  }
  return false;
}
}  // namespace hjt
