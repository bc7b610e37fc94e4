// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "arm/moving_arm.hpp"

namespace hjt
{
/// A quantity of an arm, named as in a controller's recording (RTDE).
struct ArmQuantity
{
  const char* name;
  const char* unit;
  const char* meaning;
  bool of_tool;  ///< true: the quantity has x, y and z; false: it has one number for each joint

  constexpr std::size_t width(std::size_t joints) const { return of_tool ? 3 : joints; }
};

inline constexpr std::array<ArmQuantity, 10> ARM_QUANTITIES{ {
    { "target_q", "rad", "angle of the set point", false },
    { "target_qd", "rad/s", "speed of the set point", false },
    { "target_qdd", "rad/s^2", "acceleration of the set point", false },
    { "target_current", "A", "current of the torque that the controller feeds forward", false },
    { "target_moment", "N.m", "torque of the rigid links along the set point", false },
    { "actual_q", "rad", "angle by the encoder at the output", false },
    { "actual_qd", "rad/s", "speed of the joint: speed by the encoder at the motor, divided by the ratio", false },
    { "actual_current", "A", "current of the motor", false },
    { "target_TCP_pose", "m", "position of the tool at the set points of the joints, in the frame of the base", true },
    { "actual_TCP_pose", "m", "true position of the tool in the frame of the base", true },
} };
enum ArmQuantityIndex : std::size_t
{
  TARGET_POSITION,
  TARGET_VELOCITY,
  TARGET_ACCELERATION,
  TARGET_CURRENT,
  TARGET_MOMENT,
  ACTUAL_POSITION,
  ACTUAL_VELOCITY,
  ACTUAL_CURRENT,
  TARGET_TOOL,
  ACTUAL_TOOL
};

/// The numbers of each quantity at one instant, in the order of ARM_QUANTITIES.
using ArmRow = std::array<std::vector<double>, ARM_QUANTITIES.size()>;

/// Names of the columns, "target_q_0" and so on, in the order of an ArmRow.
std::vector<std::string> armColumnNames(std::size_t joints);

/// Reads from a moving arm what its controller would record.
class ArmRecorder
{
public:
  ArmRecorder(const ArmDescription& description, MovingArm& arm);  ///< `arm` must live as long as the recorder

  /// The row of the present instant. The reference is valid until the next call.
  const ArmRow& row() noexcept;

private:
  MovingArm& arm_;
  ArmDynamics dynamics_;
  std::vector<JointMotion> target_;
  std::vector<double> inertia_in_load_;  // result of takeInertiaInLoad() for each joint [kg.m^2]
  ArmRow row_;
};

/// Sum of the counters of all drives. Only the number of steps is that of one drive, because the drives step together.
TwinCounters countersOf(const ArmTwin& twin);

bool allOnSurface(const ArmTwin& twin);  ///< whether all drives took their last step on a response surface
}  // namespace hjt
