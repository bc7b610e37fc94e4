// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/params/faults.hpp"

namespace hjt
{
/// Error message for a severity out of range; empty if it is valid. The check needs no parameters of the gear.
inline std::string severityErrors(const Fault& fault, const std::string& key)
{
  // Both comparisons are false if the severity is NaN.
  return fault.severity >= 0.0 && fault.severity <= 1.0 ?
             "" :
             key + "severity = " + numberText(fault.severity) + " [-] of " + describe(fault.kind).name +
                 " is out of range, allowed: 0 ... 1 [-]";
}
}  // namespace hjt
