// SPDX-License-Identifier: BSD-3-Clause
#include "model/faults/fault_edits.hpp"

namespace hjt
{
namespace
{
/// A crack round a part x of the circumference: the rest carries the torque, so the part of the cup that it lies in is
/// softer by 1/(1 - x). `share`: of that part in the whole compliance. The faces of the crack rub on each other.
void crackCup(const Fault& fault, double share, const Parameters& parameters, FaultEdits& edits) noexcept
{
  const double cracked = fault.severity * parameters.fault_scale.cup_crack_fraction;
  edits.cup_stiffness *= 1.0 / (1.0 + share * cracked / (1.0 - cracked));
  edits.cup_friction *= 1.0 + fault.severity * (parameters.fault_scale.cup_crack_friction_factor - 1.0);
}
}  // namespace

void editRearSectionCrack(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  crackCup(fault, parameters.fault_scale.rear_section_share, parameters, edits);
}

void editFlangeCrack(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  crackCup(fault, parameters.fault_scale.flange_share, parameters, edits);
}
}  // namespace hjt
