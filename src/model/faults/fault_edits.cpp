// SPDX-License-Identifier: BSD-3-Clause
#include "model/faults/fault_edits.hpp"

namespace hjt
{
FaultEdits::FaultEdits(int teeth)
  : mesh_stiffness(teeth)
  , clearance(teeth)
  , tip_loss(teeth)
  , flank_friction(teeth)
  , tension(teeth)
  , bending(teeth)
  , preset(teeth)
  , contact_gap(teeth)
{
  setNone();
}

void FaultEdits::setNone() noexcept
{
  for (Eigen::VectorXd* factors : { &mesh_stiffness, &flank_friction, &tension, &bending })
  {
    factors->setOnes();
  }
  for (Eigen::VectorXd* lengths : { &clearance, &tip_loss, &preset, &contact_gap })
  {
    lengths->setZero();
  }
  lobe_wear = {};
  preload_loss = spaces_off_axis = 0.0;
  cup_stiffness = cup_friction = viscosity = mesh_friction = interface_friction = 1.0;
}
}  // namespace hjt
