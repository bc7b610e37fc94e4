// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/model/faults/fault_list.hpp"
#include "model/joint_model.hpp"

namespace hjt
{
/// Keeps a joint with the faults that are active. It is made again from the sound joint, so a fault that has gone
/// leaves nothing behind. Allocates on construction only.
class JointFaults
{
public:
  explicit JointFaults(const Parameters& parameters, const FaultList& faults = {});

  /// From now on the joint has these faults, each valid, and no others.
  void apply(const FaultList& faults) noexcept;

  /// The joint as it is now: the same object for good.
  const JointModel& model() const noexcept { return model_; }

private:
  Parameters parameters_;
  JointModel sound_;
  JointModel model_;
};

/// The joint of these parameters with the faults that it has from the start.
JointModel startingJoint(const Parameters& parameters);
}  // namespace hjt
