// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/model/faults/fault_list.hpp"
#include "harmonic_joint_twin/params/faults.hpp"
#include "model/joint_model.hpp"

namespace hjt
{
/// Adds a valid fault to a joint. Several faults of one part combine: factors multiply, lengths and forces add.
/// docs/faults.md describes each kind.
void addFault(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept;

/// Parts of the joint that a fault changes, as bits of partsOf.
enum FaultPart : unsigned
{
  RIM_PART = 1,        ///< stiffness or free shape of the flexspline's rim
  CUP_PART = 2,        ///< wall of the flexspline's cup
  MESH_PART = 4,       ///< teeth
  GENERATOR_PART = 8,  ///< wave generator with its bearing, or its contact with the rim
  FRICTION_PART = 16
};
unsigned partsOf(const Fault& fault, const GearParameters& gear) noexcept;

/// Whether a crack at a tooth's root runs through the tooth (true) or into the rim (false), by the backup ratio rim
/// thickness / tooth height (thesis 3.4.2): through the tooth above 1, into the rim below 0.4. In between, the worse
/// case is assumed.
bool rootCrackRunsThroughTooth(const GearParameters& gear) noexcept;

/// A joint with its active faults. Each change starts from the sound joint, so that a removed fault leaves no trace.
/// Only the construction allocates.
class JointFaults
{
public:
  explicit JointFaults(const Parameters& parameters, const FaultList& faults = {})
    : parameters_(parameters), sound_(parameters), model_(sound_)
  {
    apply(faults);
  }

  /// Replaces the faults of the joint by these valid ones.
  void apply(const FaultList& faults) noexcept
  {
    model_ = sound_;  // the vectors have equal size, so nothing is allocated
    for (const ActiveFault& active : faults)
    {
      addFault(active.fault, parameters_, model_);
    }
  }

  /// The joint with its present faults; the reference stays valid.
  const JointModel& model() const noexcept { return model_; }

private:
  Parameters parameters_;
  JointModel sound_;
  JointModel model_;
};

/// The faults that a joint with these parameters has at the start.
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

/// The joint with the faults of the start.
inline JointModel startingJoint(const Parameters& parameters)
{
  return JointFaults(parameters, faultsAtStart(parameters)).model();
}
}  // namespace hjt
