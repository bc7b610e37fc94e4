// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "harmonic_joint_twin/params/faults.hpp"

namespace hjt
{
/// Fault whose severity grows linearly with time from its onset.
struct GrowingFault
{
  static constexpr int STEPS = 40;  ///< number of equal steps that approximate the growth, with an error of half a step
  static constexpr double MAX_RAMP = 1e9;  ///< largest duration of the growth [s]

  Fault fault;
  double ramp{};  ///< duration of the growth; 0: the fault has its full severity at once [s]

  double severityAt(double time) const  ///< severity at `time`, counted from the start [s]
  {
    const double gone = time - fault.onset;
    return gone < 0.0 ? 0.0 : gone < ramp ? fault.severity * gone / ramp : fault.severity;
  }

  /// Faults that approximate the growth: one fault for each step, ordered by onset.
  std::vector<Fault> steps() const
  {
    if (ramp <= 0.0)
    {
      return { fault };
    }
    std::vector<Fault> steps(STEPS, fault);
    for (int step = 0; step < STEPS; ++step)
    {
      steps[static_cast<std::size_t>(step)].severity *= (step + 1.0) / STEPS;
      steps[static_cast<std::size_t>(step)].onset += ramp * (step + 0.5) / STEPS;
    }
    return steps;
  }
};
}  // namespace hjt
