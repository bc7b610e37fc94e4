// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/params/faults.hpp"
#include "life/assessment_counts.hpp"
#include "life/wear_trend.hpp"

namespace hjt
{
/// How reliable assessments of wear are, by the runs of docs/health.md. As they are few, a share is the mean of what
/// they leave open: one more counts on either side (Laplace's rule of succession).
namespace assessment_errors
{
constexpr double shareOf(double found, double runs) noexcept
{
  return (found + 1.0) / (runs + 2.0);
}

/// Share of drives whose wear of a kind is found at all: of the runs judged at severities 0.2 and 0.5, check-up and
/// work together. 0: never, spalls among them [-].
constexpr double detectionShare(FaultKind kind) noexcept
{
  switch (kind)
  {
    case FaultKind::TOOTH_WEAR:
      return shareOf(assessment_counts::TOOTH_WEAR_FOUND, assessment_counts::TOOTH_WEAR_RUNS);
    case FaultKind::INTERFACE_WEAR:
      return shareOf(assessment_counts::INTERFACE_WEAR_FOUND, assessment_counts::INTERFACE_WEAR_RUNS);
    case FaultKind::LUBRICANT_DEGRADATION:
      return shareOf(assessment_counts::LUBRICANT_DEGRADATION_FOUND, assessment_counts::LUBRICANT_DEGRADATION_RUNS);
    default:
      return 0.0;
  }
}

/// Smallest severity that is found, log-normal from drive to drive: median, standard deviation of the logarithm.
/// Assumed: the smallest severity of a signature; 0.2 is found.
constexpr double DETECTED_SEVERITY = 0.1;
constexpr double DETECTED_SPREAD = 0.3;

/// Of the alarms at severity >= 0.3 by these three kinds: the first cause is right, one of the reported set.
constexpr double RIGHT_CAUSE = shareOf(assessment_counts::RIGHT_CAUSES, assessment_counts::ALARMS);
constexpr double IN_SET = shareOf(assessment_counts::IN_SETS, assessment_counts::ALARMS);

/// Of check-ups and runs at work of sound gears that end with an alarm.
constexpr double FALSE_ALARMS = shareOf(assessment_counts::SOUND_ALARMS, assessment_counts::SOUND_RUNS);

/// How WearReadings depart from the wear of flanks and interface, counted on lives with signals (seeds 11 and 421 of
/// lab/lives_judged.py). In a motion like one of the signatures' the gain of the flanks differs by 0.06 from gear
/// to gear.
constexpr ReadingErrors FLANK_READING{ 0.06, 0.012, 0.005, 0.03 };
constexpr ReadingErrors INTERFACE_READING{ 0.2, 0.08, 0.015, 0.03 };
/// Standard deviation of the gain in a motion unlike all of them, as `motion_error` of the signatures [-].
constexpr double OTHER_MOTION_GAIN = 0.25;
/// Wear of the flanks first takes up the preload and opens no play: mean of what readings are short by, as a severity;
/// its standard deviation from drive to drive is FLANK_READING.offset.
constexpr double FLANK_SHORT = 0.012;
/// Bias of the interface's reading by the flanks' wear, over the flanks' reading: mean, standard deviation [-].
constexpr double INTERFACE_SHORT = 0.55;
constexpr double FLANK_IN_INTERFACE = 0.2;

}  // namespace assessment_errors
}  // namespace hjt
