// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdlib>

#include "gear/angle.hpp"
#include "model/faults/fault_edits.hpp"

namespace hjt
{
void crackRim(int segment, double severity, const Parameters& parameters, FaultEdits& edits) noexcept
{
  const double left = 1.0 - severity * parameters.fault_scale.rim_crack_depth;
  edits.tension[segment] *= left;
  edits.bending[segment] *= left * left * left;
}

void editFlexsplineCrack(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  const int teeth = parameters.gear.teeth_flexspline;
  const int reach = parameters.fault_scale.rim_crack_segments;
  for (int i = 0; i < teeth; ++i)
  {
    const int apart = std::abs(i - fault.place);
    const int away = apart < teeth - apart ? apart : teeth - apart;
    if (away < reach)
    {
      crackRim(i, fault.severity * (1.0 - static_cast<double>(away) / reach), parameters, edits);
    }
  }
}

/// Worn rim and race stand back from each other, and slip more roughly: over one segment in proportion.
void editInterfaceWear(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  const double part = fault.place == WHOLE_MEMBER ? 1.0 : 1.0 / parameters.gear.teeth_flexspline;
  atPlace(fault.place, edits.contact_gap,
          [&](double& gap) { gap += fault.severity * parameters.fault_scale.interface_wear_depth; });
  edits.interface_friction *= 1.0 + fault.severity * part * (parameters.fault_scale.interface_friction_factor - 1.0);
}

/// The free rim would stand in waves e cos(n psi): its curvature changes by (n^2 - 1) e cos(n psi) / r^2.
void editBuckling(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  const FaultScaleParameters& scale = parameters.fault_scale;
  const int teeth = parameters.gear.teeth_flexspline;
  const int waves = scale.buckling_waves;
  const double radius = parameters.gear.flexspline_inner_radius;
  const double amplitude = fault.severity * scale.buckling_out_of_round * (waves * waves - 1.0) / radius;
  for (int i = 0; i < teeth; ++i)
  {
    edits.preset[i] += amplitude * TWO_PI / teeth * std::cos(TWO_PI * waves * i / teeth);
  }
  edits.cup_stiffness *= 1.0 - fault.severity * scale.buckling_stiffness_loss;
}
}  // namespace hjt
