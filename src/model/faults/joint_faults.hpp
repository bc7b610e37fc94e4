// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/model/faults/fault_list.hpp"
#include "harmonic_joint_twin/params/faults.hpp"
#include "model/joint_model.hpp"

namespace hjt
{
/// Edits a joint to one fault more, a valid one. Several on one part compose: factors multiply, lengths and forces add.
/// docs/faults.md says what each kind stands for.
void addFault(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept;

/// Parts of the joint that a fault changes: bits of partsOf.
enum FaultPart : unsigned
{
  RIM_PART = 1,        ///< stiffness or free shape of the flexspline's rim
  CUP_PART = 2,        ///< wall of its cup
  MESH_PART = 4,       ///< teeth
  GENERATOR_PART = 8,  ///< wave generator with its bearing, or how the rim lies on it
  FRICTION_PART = 16
};
unsigned partsOf(const Fault& fault, const GearParameters& gear) noexcept;

/// Whether a crack at a tooth's root runs through the tooth (true) or into the rim, by the backup ratio rim thickness /
/// tooth height (thesis 3.4.2): through the tooth above 1, into the rim below 0.4. Between both the worse is taken.
bool rootCrackRunsThroughTooth(const GearParameters& gear) noexcept;

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
