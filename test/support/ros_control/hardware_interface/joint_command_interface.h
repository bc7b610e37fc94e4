// SPDX-License-Identifier: BSD-3-Clause
/// As joint_state_interface.h.
#pragma once

#include <hardware_interface/joint_state_interface.h>

namespace hardware_interface
{
class JointHandle : public JointStateHandle
{
public:
  JointHandle(const JointStateHandle& state, double* command) : JointStateHandle(state), command_(command) {}

  void setCommand(double command) { *command_ = command; }
  double getCommand() const { return *command_; }

private:
  double* command_;
};

class JointCommandInterface : public HardwareResourceManager<JointHandle>
{
};

class EffortJointInterface : public JointCommandInterface
{
};
}  // namespace hardware_interface
