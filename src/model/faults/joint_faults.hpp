// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/model/faults/fault_list.hpp"
#include "harmonic_joint_twin/params/faults.hpp"
#include "model/joint_model.hpp"

namespace hjt
{
/// Adds a valid fault to a joint. If several faults change a quantity of the joint, their factors are multiplied, and
/// their lengths and forces are added. docs/faults.md describes each kind of fault.
void addFault(const Fault& fault, const Parameters& parameters, JointModel& joint) noexcept;

/// Parts of the joint that a fault can change. The result of partsOf has one bit for each part.
enum FaultPart : unsigned
{
  RIM_PART = 1,        ///< stiffness or free shape of the flexspline's rim
  CUP_PART = 2,        ///< wall of the flexspline's cup
  MESH_PART = 4,       ///< teeth of the flexspline or the circular spline
  GENERATOR_PART = 8,  ///< wave generator, its bearing, or its contact with the rim
  FRICTION_PART = 16
};
unsigned partsOf(const Fault& fault, const GearParameters& gear) noexcept;

/// Whether a crack at a tooth's root runs through the tooth (true) or into the rim (false). The answer depends on the
/// backup ratio, rim thickness / tooth height (thesis 3.4.2): above 1 the crack runs through the tooth, below 0.4 into
/// the rim. Between 0.4 and 1 the function assumes the worse case, the rim.
bool rootCrackRunsThroughTooth(const GearParameters& gear) noexcept;

/// Joint with its active faults. Each change of the faults starts from the sound joint, so that a removed fault leaves
/// no trace. Only the constructor allocates memory.
class JointFaults
{
public:
  explicit JointFaults(const Parameters& parameters, const FaultList& faults = {})
    : parameters_(parameters), sound_(parameters), model_(sound_)
  {
    apply(faults);
  }

  /// Replaces the faults of the joint by `faults`, which must be valid.
  void apply(const FaultList& faults) noexcept
  {
    model_ = sound_;  // allocates nothing, because the vectors of both models have equal sizes
    for (const ActiveFault& active : faults)
    {
      addFault(active.fault, parameters_, model_);
    }
  }

  /// Joint with its present faults. The reference stays valid after `apply`.
  const JointModel& model() const noexcept { return model_; }

private:
  Parameters parameters_;
  JointModel sound_;
  JointModel model_;
};

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

inline JointModel startingJoint(const Parameters& parameters)
{
  return JointFaults(parameters, faultsAtStart(parameters)).model();
}
}  // namespace hjt
