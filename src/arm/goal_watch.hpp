// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "arm/moving_arm.hpp"
#include "base/publish_period.hpp"

namespace hjt
{
/// How far a joint may be off its set point.
struct JointTolerance
{
  double position{ HUGE_VAL };  ///< [rad]
  double velocity{ HUGE_VAL };  ///< [rad/s]
};

/// Tolerances of a commanded motion.
struct ArmGoal
{
  std::uint64_t number{};            ///< of the command; later ones have larger numbers
  std::vector<JointTolerance> path;  ///< of each joint on the way; empty: nobody asks
  std::vector<JointTolerance> end;   ///< and when it is to be there
  double patience{};                 ///< how long after the motion's end that may be [s]
};

enum class GoalState : std::uint8_t
{
  NONE,       ///< nobody asks
  UNDER_WAY,  ///< on the way or not there yet
  REACHED,    ///< there in time
  OFF_PATH,   ///< beyond a tolerance on the way
  NOT_THERE,  ///< beyond a tolerance when the patience ended
  STOPPED,    ///< by a protective stop
  FORGOTTEN   ///< the arm was reset
};

/// How it follows. Of the last command taken.
struct GoalReport
{
  std::uint64_t number{};
  GoalState state{};
  Stamp stamp{};                    ///< at which all this was [ns]
  std::size_t joint{};              ///< the one beyond its tolerance
  bool is_speed{};                  ///< it was its speed's
  double error{};                   ///< by which it was off [rad], [rad/s]
  double tolerance{};               ///< likewise
  std::vector<JointMotion> wanted;  ///< set point
  std::vector<JointMotion> actual;  ///< reported by the controller, without accelerations
};

/// Judges at the arm's states whether it follows what it was commanded, as joint_trajectory_controller does. After
/// construction nothing throws or allocates.
class GoalWatch
{
public:
  GoalWatch(const ArmDescription& arm, const ArmTwin& twin)
    : period_(publishPeriod(arm.state_rate, twin.drive(0).parameters().solver.rate))
  {
    report_.wanted.resize(twin.joints());
    report_.actual.resize(twin.joints());
  }

  /// Of a motion that the arm follows from now on; in exchange for the last one.
  void begin(ArmGoal& goal) noexcept
  {
    std::swap(goal_, goal);
    report_.number = goal_.number;
    report_.state = goal_.path.empty() ? GoalState::NONE : GoalState::UNDER_WAY;
  }

  void forget() noexcept
  {
    report_.state = report_.state == GoalState::UNDER_WAY ? GoalState::FORGOTTEN : report_.state;
  }

  /// To be called at every step.
  void look(MovingArm& arm) noexcept
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

  const GoalReport& report() const noexcept { return report_; }

private:
  /// The first joint that is, in the report.
  bool isBeyond(const std::vector<JointTolerance>& tolerances) noexcept
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

  Stamp period_;  // of the states [ns]
  ArmGoal goal_;
  GoalReport report_;
};
}  // namespace hjt
