// SPDX-License-Identifier: BSD-3-Clause
#include "model/faults/fault_edits.hpp"

namespace hjt
{
void editLubricantDegradation(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  const double friction = 1.0 + fault.severity * (parameters.fault_scale.boundary_friction_factor - 1.0);
  edits.viscosity *= 1.0 + fault.severity * (parameters.fault_scale.viscosity_factor - 1.0);
  edits.mesh_friction *= friction;
  edits.interface_friction *= friction;
}
}  // namespace hjt
