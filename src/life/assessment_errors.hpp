// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/faults.hpp"
#include "life/wear_trend.hpp"

namespace hjt
{
/// How reliable assessments of wear are, counted on runs of six gears as in docs/health.md. As they are few, a share is
/// the mean of what they leave open: one more counts on either side (Laplace's rule of succession).
namespace assessment_errors
{
/// Share of drives whose wear of a kind is found at all: of the windows judged at severities 0.2 and 0.5, check-up and
/// work together. 0: never, spalls among them [-].
constexpr double detectionShare(FaultKind kind) noexcept
{
  switch (kind)
  {
    case FaultKind::TOOTH_WEAR:
      return (17.0 + 1.0) / (19.0 + 2.0);
    case FaultKind::INTERFACE_WEAR:
      return (20.0 + 1.0) / (20.0 + 2.0);
    case FaultKind::LUBRICANT_DEGRADATION:
      return (19.0 + 1.0) / (20.0 + 2.0);
    default:
      return 0.0;
  }
}

/// Smallest severity that is found, log-normal from drive to drive: median, standard deviation of the logarithm.
/// Assumed: the smallest severity of a signature; 0.2 is found.
constexpr double DETECTED_SEVERITY = 0.1;
constexpr double DETECTED_SPREAD = 0.3;

/// In 29 alarms at severity >= 0.3 by these three kinds the first cause was right in 25, one of the reported set in 26.
constexpr double RIGHT_CAUSE = (25.0 + 1.0) / (29.0 + 2.0);
constexpr double IN_SET = (26.0 + 1.0) / (29.0 + 2.0);

/// Of 304 check-ups and runs at work of sound gears none ended with an alarm.
constexpr double FALSE_ALARMS = (0.0 + 1.0) / (304.0 + 2.0);

/// How WearReadings depart from the wear of flanks and interface, counted on lives with signals (seed 11,
/// docs/life.md): gears of other preload show the first micrometre late, signatures of other motions are off by a
/// tenth.
constexpr ReadingErrors FLANK_READING{ 0.12, 0.025, 0.005, 0.03 };
constexpr ReadingErrors INTERFACE_READING{ 0.2, 0.08, 0.015, 0.03 };
/// Standard deviation of what the flanks' wear adds to the interface's reading, over the flanks' reading [-].
constexpr double FLANK_IN_INTERFACE = 0.4;

}  // namespace assessment_errors
}  // namespace hjt
