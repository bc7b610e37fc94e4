// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "harmonic_joint_twin/health/baseline.hpp"
#include "harmonic_joint_twin/health/fault_signatures.hpp"
#include "harmonic_joint_twin/params/faults.hpp"
#include "life/ageing_laws.hpp"
#include "life/assessment_counts.hpp"
#include "life/remaining_life.hpp"
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

/// How far windows say that a drive has worn since its reference was learned, as severities of the faults. Below what
/// shows it may be negative.
struct WearReading
{
  bool is_read{};              ///< false: the load did not go both ways, or nothing is known of what wear changes
  double flank{};              ///< tooth_wear [-]
  double interface = 0.0;      ///< interface_wear [-]
  double alike{};              ///< how far the motion is like one that the signatures are known in, 0 ... 1 [-]
  double lost_motion{};        ///< of the windows [rad]
  double lost_motion_slope{};  ///< that one unit of `flank` adds, at the largest severities of the signatures [rad]
};

/// Reads the mean of the last windows, whatever the verdict.
///
/// Law:   w(s_f) = d_w,   sum over K1, K2 of (k(s_f) + l_k(s_i)) / k_0 = sum of d_k / k_0
/// where  w, k, l  change of lost motion and of a stiffness by worn teeth, of a stiffness by a worn interface: means of
///                 the signatures, weighted by how far their motions are alike, straight between their severities
///        d, k_0   differences from the reference; stiffness of the sound drive
/// Lost motion is worn teeth's alone: no other wear moves it by a tenth as much. Of the stiffness both softenings
/// together are taken: how they are shared by K1 and K2 depends on how far the load reaches.
WearReading readWear(const WindowResidual& residual, const OperatingPoint& point, const SignatureSet& set) noexcept;

/// Wear as it was read at some hours of use.
struct DatedReading
{
  double hours;
  WearReading reading;
};

/// Wear that was read over the use.
struct ReadWear
{
  std::vector<DatedReading> readings;    ///< in the order of hours
  double lost_motion_limit{ HUGE_VAL };  ///< at which the drive is at its end, as the windows have it [rad]
};

/// Wear by readings, over the nominal use. `reference_hours`: of use when the reference was learned [h].
inline WearTrends trendsOf(const ReadWear& read, const NominalUse& use, const FaultScaleParameters& fault_scale,
                           double reference_hours)
{
  WearTrends trends;
  if (read.readings.empty())
  {
    return trends;
  }
  const double flank = fault_scale.tooth_wear_depth;
  const double interface = fault_scale.interface_wear_depth;
  const Usage at_reference = use.until(reference_hours);
  std::vector<WearPoint> flank_points;
  std::vector<WearPoint> interface_points;
  for (const auto& [hours, reading] : read.readings)
  {
    const Usage then = use.until(hours);
    const double worn_flank = reading.flank + assessment_errors::FLANK_SHORT;
    const double worn_interface = reading.interface + assessment_errors::INTERFACE_SHORT * reading.flank;
    flank_points.push_back(
        { (then.mean_flank - at_reference.mean_flank) / flank, use.flank().of(worn_flank * flank) / flank });
    interface_points.push_back({ (then.interface_wear - at_reference.interface_wear) / interface,
                                 use.interface().of(worn_interface * interface) / interface });
  }
  const double unlike = std::sqrt(1.0 - read.readings.back().reading.alike);
  ReadingErrors flank_errors = assessment_errors::FLANK_READING;
  flank_errors.gain = std::hypot(flank_errors.gain, assessment_errors::OTHER_MOTION_GAIN * unlike);
  trends.flank = { flank_points, flank_errors, RATE_SCATTER };
  ReadingErrors interface_errors = assessment_errors::INTERFACE_READING;
  interface_errors.offset =
      std::hypot(interface_errors.offset, assessment_errors::FLANK_IN_INTERFACE * read.readings.back().reading.flank);
  trends.interface = { interface_points, interface_errors, RATE_SCATTER };
  if (std::isfinite(read.lost_motion_limit))
  {
    const WearReading& last = read.readings.back().reading;
    const double at_end = last.flank + assessment_errors::FLANK_SHORT +
                          (read.lost_motion_limit - last.lost_motion) / last.lost_motion_slope;
    const Usage now = use.until(read.readings.back().hours);
    // Nominal severities are of the mean of both flanks, the depth at the end of the worse.
    trends.flank_depth = now.mean_flank > 0.0 ? flank * now.flank_wear / now.mean_flank : flank;
    trends.reading_at_end = use.flank().of(at_end * flank) / flank;
  }
  return trends;
}
}  // namespace hjt
