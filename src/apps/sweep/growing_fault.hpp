// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/faults.hpp"

namespace hjt
{
/// A fault of a run: from its onset on it grows evenly to its severity.
struct GrowingFault
{
  Fault fault;
  double ramp{};  ///< time of growth; 0: at once [s]

  double severityAt(double time) const  ///< `time` since the start [s]
  {
    const double gone = time - fault.onset;
    return gone < 0.0 ? 0.0 : gone < ramp ? fault.severity * gone / ramp : fault.severity;
  }
};
}  // namespace hjt
