// SPDX-License-Identifier: BSD-3-Clause
#include "model/faults/joint_faults.hpp"

#include <array>

namespace hjt
{
namespace
{
/// By kind.
constexpr std::array<FaultEdit, FAULT_KINDS> EDITS{
  editInterfaceWear,    editRearSectionCrack, editLubricantDegradation,
  editToothWear,        editToothRootCrack,   editFlangeCrack,
  editToothTipCrack,    editPitting,          editWaveGeneratorWear,
  editFlexsplineCrack,  editBuckling,         editRatcheting,
  editBearingInnerRace, editBearingOuterRace, editBearingBall,
  editBearingCage
};
}  // namespace

JointFaults::JointFaults(const Parameters& parameters, JointModel& model)
  : parameters_(parameters)
  , model_(model)
  , edits_(parameters.gear.teeth_flexspline)
  , mesh_stiffness_(model.ring.mesh.stiffness())
  , tension_stiffness_(model.ring.tension.stiffness())
  , bending_stiffness_(model.ring.bending.stiffness())
{
}

void JointFaults::apply(const FaultList& faults) noexcept
{
  edits_.setNone();
  BearingSag& bearing = model_.ring.contact.bearing();
  bearing.clear();
  for (const ActiveFault& active : faults)
  {
    EDITS[static_cast<std::size_t>(active.fault.kind)](active.fault, parameters_, edits_, bearing);
  }
  edit();
}

void JointFaults::edit() noexcept
{
  RingModel& ring = model_.ring;
  ring.mesh.stiffness() = mesh_stiffness_.cwiseProduct(edits_.mesh_stiffness);
  ring.mesh.clearance() = edits_.clearance;
  ring.mesh.tipLoss() = edits_.tip_loss;
  ring.mesh.moveSpaces(edits_.spaces_off_axis);
  ring.tension.stiffness() = tension_stiffness_.cwiseProduct(edits_.tension);
  ring.bending.stiffness() = bending_stiffness_.cwiseProduct(edits_.bending);
  ring.bending.preset() = edits_.preset;
  ring.contact.gap() = edits_.contact_gap;
  ring.contact.wear(edits_.lobe_wear[0], edits_.lobe_wear[1]);
  ring.cup.scaleStiffness(edits_.cup_stiffness);
  model_.mesh_friction.scale(edits_.mesh_friction);
  model_.mesh_friction.toothFactor() = edits_.flank_friction;
  model_.cup_friction.scale(edits_.cup_friction);
  model_.interface_friction.scale(edits_.interface_friction);
  model_.bearing.scaleViscosity(edits_.viscosity);
  model_.bearing.loosen(edits_.preload_loss, parameters_.fault_scale.race_bending_preload);
}

JointModel startingJoint(const Parameters& parameters)
{
  JointModel model(parameters);
  FaultList faults;
  for (const Fault& fault : parameters.faults)
  {
    if (fault.isThereFromTheStart())
    {
      faults.set(fault, 0);
    }
  }
  JointFaults(parameters, model).apply(faults);
  return model;
}
}  // namespace hjt
