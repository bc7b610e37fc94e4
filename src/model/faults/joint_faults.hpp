// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/model/faults/fault_list.hpp"
#include "model/faults/fault_edits.hpp"
#include "model/joint_model.hpp"

namespace hjt
{
/// Keeps a joint with the faults that are active. It is made again from the sound joint, so a fault that has gone
/// leaves nothing behind. Allocates on construction only.
class JointFaults
{
public:
  explicit JointFaults(const Parameters& parameters, const FaultList& faults = {})
    : parameters_(parameters), sound_(parameters), model_(sound_)
  {
    apply(faults);
  }

  /// Gives the joint these faults, each valid, in place of those before.
  void apply(const FaultList& faults) noexcept
  {
    model_ = sound_;  // vectors of equal size: nothing is allocated
    for (const ActiveFault& active : faults)
    {
      addFault(active.fault, parameters_, model_);
    }
  }

  /// The joint as it is now: the same object for good.
  const JointModel& model() const noexcept { return model_; }

private:
  Parameters parameters_;
  JointModel sound_;
  JointModel model_;
};

/// The faults that a joint of these parameters has from the start.
inline FaultList faultsAtStart(const Parameters& parameters)
{
  FaultList faults;
  for (const Fault& fault : parameters.faults)
  {
    if (fault.isActiveAtStart())
    {
      faults.set(fault, 0);
    }
  }
  return faults;
}

/// The joint with them.
inline JointModel startingJoint(const Parameters& parameters)
{
  return JointFaults(parameters, faultsAtStart(parameters)).model();
}
}  // namespace hjt
