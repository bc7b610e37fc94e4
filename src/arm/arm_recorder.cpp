// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_recorder.hpp"

#include "arm/arm_configuration.hpp"
#include "twin/step_counters.hpp"

namespace hjt
{
std::vector<std::string> armColumnNames(std::size_t joints)
{
  std::vector<std::string> names;
  for (const ArmQuantity& quantity : ARM_QUANTITIES)
  {
    for (std::size_t i = 0; i < quantity.width(joints); ++i)
    {
      names.push_back(quantity.name + ("_" + std::to_string(i)));
    }
  }
  return names;
}

ArmRecorder::ArmRecorder(const ArmDescription& description, MovingArm& arm)
  : arm_(arm), dynamics_(description), target_(description.joints.size())
{
  for (std::size_t i = 0; i < target_.size(); ++i)
  {
    Parameters drive = arm.twin().drive(i).parameters();
    inertia_in_load_.push_back(takeInertiaInLoad(drive));
  }
  for (std::size_t k = 0; k < row_.size(); ++k)
  {
    row_[k].resize(ARM_QUANTITIES[k].width(target_.size()));
  }
}

const ArmRow& ArmRecorder::row() noexcept
{
  arm_.wanted(target_);
  const ArmController& controller = arm_.controller();
  for (std::size_t i = 0; i < target_.size(); ++i)
  {
    const double gain = arm_.twin().drive(i).parameters().telemetry.torque_per_current;
    const JointReading read = arm_.reading(i);
    const JointMotion& target = target_[i];
    row_[TARGET_POSITION][i] = target.position;
    row_[TARGET_VELOCITY][i] = target.velocity;
    row_[TARGET_ACCELERATION][i] = target.acceleration;
    row_[TARGET_CURRENT][i] = controller.feedForward(i) / gain;
    row_[TARGET_MOMENT][i] = controller.rigidTorques()[i] + inertia_in_load_[i] * target.acceleration;
    row_[ACTUAL_POSITION][i] = read.position;
    row_[ACTUAL_VELOCITY][i] = read.velocity;
    row_[ACTUAL_CURRENT][i] = read.current;
  }
  const ToolPose wanted = dynamics_.toolPose(target_);
  const ToolPose tool = arm_.twin().toolPose();
  row_[TARGET_TOOL].assign(wanted.position.begin(), wanted.position.end());
  row_[ACTUAL_TOOL].assign(tool.position.begin(), tool.position.end());
  return row_;
}

TwinCounters countersOf(const ArmTwin& twin)
{
  TwinCounters sum;
  for (std::size_t i = 0; i < twin.joints(); ++i)
  {
    for (const auto& [name, count] : STEP_COUNTERS)
    {
      sum.*count += twin.drive(i).counters().*count;
    }
  }
  sum.steps = twin.drive(0).counters().steps;
  return sum;
}

bool allOnSurface(const ArmTwin& twin)
{
  bool all = true;
  for (std::size_t i = 0; i < twin.joints(); ++i)
  {
    all = all && twin.drive(i).onSurface();
  }
  return all;
}
}  // namespace hjt
