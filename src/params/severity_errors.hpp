// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/params/faults.hpp"

namespace hjt
{
/// Of a fault's severity, which no gear need be known for, as faultErrors has it; empty if it is valid.
inline std::string severityErrors(const Fault& fault, const std::string& key)
{
  // Written so that NaN fails.
  return fault.severity >= 0.0 && fault.severity <= 1.0 ?
             "" :
             key + "severity = " + numberText(fault.severity) + " [-] of " + describe(fault.kind).name +
                 " is out of range, allowed: 0 ... 1 [-]";
}
}  // namespace hjt
