// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "gear/angle.hpp"
#include "model/faults/joint_faults.hpp"

namespace hjt
{
namespace
{
/// Stiffness of a tooth pair, to that of a sound one, whose flexspline tooth has `bending` of its stiffness in bending left:
/// that part of the pair's compliance grows, the rest stays.
double softened(double bending, double share) noexcept
{
  return bending / (bending + share * (1.0 - bending));
}

/// Stiffness in bending left of a tooth, a cantilever, that has lost `loss` of its thickness.
double thinned(double loss) noexcept
{
  const double left = loss < 1.0 ? 1.0 - loss : 0.0;
  return left * left * left;
}

/// The same of one that a crack along its middle has split over `length` of its height from the tip on: there two leaves of
/// half its thickness bend, four times as much, under a force at the tip.
double split(double length) noexcept
{
  return 1.0 / (1.0 + 3.0 * length * length * length);
}
}  // namespace

bool rootCrackRunsThroughTooth(const GearParameters& gear) noexcept
{
  return gear.rim_thickness > gear.tooth_height_flexspline;
}

void editToothWear(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  const GearParameters& gear = parameters.gear;
  const double across =
      fault.severity * parameters.fault_scale.tooth_wear_depth / std::cos(parameters.mesh.flank_angle);
  // Half the pitch at mid-height.
  const double thickness = PI * (gear.flexspline_inner_radius + gear.toothMidHeight()) / gear.teeth_flexspline;
  const double factor = softened(thinned(2.0 * across / thickness), parameters.fault_scale.tooth_compliance_share);
  atPlace(fault.place, edits.clearance, [&](double& clearance) { clearance += across; });
  atPlace(fault.place, edits.mesh_stiffness, [&](double& stiffness) { stiffness *= factor; });
}

void editToothRootCrack(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  if (rootCrackRunsThroughTooth(parameters.gear))
  {
    edits.mesh_stiffness[fault.place] *=
        softened(thinned(fault.severity), parameters.fault_scale.tooth_compliance_share);
  }
  else
  {
    crackRim(fault.place, fault.severity, parameters, edits);
  }
}

void editToothTipCrack(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  edits.mesh_stiffness[fault.place] *= softened(split(fault.severity), parameters.fault_scale.tooth_compliance_share);
}

void editPitting(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  const double width = 1.0 - fault.severity * parameters.fault_scale.pitted_fraction;
  const double friction = 1.0 + fault.severity * (parameters.fault_scale.pitted_friction_factor - 1.0);
  atPlace(fault.place, edits.mesh_stiffness, [&](double& stiffness) { stiffness *= width; });
  atPlace(fault.place, edits.flank_friction, [&](double& factor) { factor *= friction; });
}

/// What a jump leaves behind: worn tips, and a circular spline that is no more coaxial.
void editRatcheting(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  edits.spaces_off_axis += fault.severity * parameters.fault_scale.ratcheting_eccentricity;
  edits.tip_loss.array() += fault.severity * parameters.fault_scale.ratcheting_tip_loss;
}
}  // namespace hjt
