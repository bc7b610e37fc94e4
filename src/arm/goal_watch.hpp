// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "arm/moving_arm.hpp"

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
  GoalWatch(const ArmDescription& arm, const ArmTwin& twin);

  /// Of a motion that the arm follows from now on; in exchange for the last one.
  void begin(ArmGoal& goal) noexcept;
  void forget() noexcept;

  /// To be called at every step.
  void look(MovingArm& arm) noexcept;

  const GoalReport& report() const noexcept { return report_; }

private:
  bool isBeyond(const std::vector<JointTolerance>& tolerances) noexcept;

  Stamp period_;  // of the states [ns]
  ArmGoal goal_;
  GoalReport report_;
};
}  // namespace hjt
