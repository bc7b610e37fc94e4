// SPDX-License-Identifier: BSD-3-Clause
#include "elements/bearing_sag.hpp"
#include "gear/angle.hpp"
#include "model/faults/fault_edits.hpp"

namespace hjt
{
namespace
{
double placeOnRace(const Fault& fault, const Parameters& parameters) noexcept
{
  return TWO_PI * fault.place / parameters.gear.teeth_flexspline;
}

double spallDepth(const Fault& fault, const Parameters& parameters) noexcept
{
  return fault.severity * parameters.fault_scale.spall_depth;
}
}  // namespace

void editBearingInnerRace(const Fault& fault, const Parameters& parameters, FaultEdits&, BearingSag& bearing) noexcept
{
  bearing.addInnerSpall(placeOnRace(fault, parameters), spallDepth(fault, parameters),
                        parameters.fault_scale.spall_length);
}

void editBearingOuterRace(const Fault& fault, const Parameters& parameters, FaultEdits&, BearingSag& bearing) noexcept
{
  bearing.addOuterSpall(placeOnRace(fault, parameters), spallDepth(fault, parameters),
                        parameters.fault_scale.spall_length);
}

void editBearingBall(const Fault& fault, const Parameters& parameters, FaultEdits&, BearingSag& bearing) noexcept
{
  bearing.addBallSpall(fault.place, spallDepth(fault, parameters), parameters.fault_scale.spall_length);
}

void editBearingCage(const Fault& fault, const Parameters& parameters, FaultEdits&, BearingSag& bearing) noexcept
{
  bearing.addIdleBall(fault.place, fault.severity * parameters.fault_scale.cage_sag);
}
}  // namespace hjt
