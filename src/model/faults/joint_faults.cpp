// SPDX-License-Identifier: BSD-3-Clause
#include "model/faults/joint_faults.hpp"

#include "model/faults/fault_edits.hpp"

namespace hjt
{
JointFaults::JointFaults(const Parameters& parameters, const FaultList& faults)
  : parameters_(parameters), sound_(parameters), model_(sound_)
{
  apply(faults);
}

void JointFaults::apply(const FaultList& faults) noexcept
{
  model_ = sound_;  // vectors of equal size: nothing is allocated
  for (const ActiveFault& active : faults)
  {
    addFault(active.fault, parameters_, model_);
  }
}

JointModel startingJoint(const Parameters& parameters)
{
  FaultList faults;
  for (const Fault& fault : parameters.faults)
  {
    if (fault.isThereFromTheStart())
    {
      faults.set(fault, 0);
    }
  }
  return JointFaults(parameters, faults).model();
}
}  // namespace hjt
