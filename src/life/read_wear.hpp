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
/// Reliability of assessments of wear in the runs of docs/health.md. Because the runs are few, a share is the posterior
/// mean with one additional success and failure (Laplace's rule of succession).
namespace assessment_errors
{
constexpr double shareOf(double found, double runs) noexcept
{
  return (found + 1.0) / (runs + 2.0);
}

/// Share of drives whose wear of a kind the assessment finds [-], counted over check-ups and runs at work with the
/// severities 0.2 and 0.5. For kinds of faults that are no wear of teeth, interface or grease the share is 0.
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

/// Smallest severity that the assessment finds, log-normal over drives: median, and standard deviation of the
/// logarithm. Assumption: the smallest severity of a signature, because the assessment finds 0.2.
constexpr double DETECTED_SEVERITY = 0.1;
constexpr double DETECTED_SPREAD = 0.3;

/// Shares of alarms, by wear and degraded lubricant of severity 0.3 or more, with the right most likely cause
/// (RIGHT_CAUSE) and with the right cause in the reported set (IN_SET) [-].
constexpr double RIGHT_CAUSE = shareOf(assessment_counts::RIGHT_CAUSES, assessment_counts::ALARMS);
constexpr double IN_SET = shareOf(assessment_counts::IN_SETS, assessment_counts::ALARMS);

/// Share of check-ups and runs at work of sound gears that end with an alarm [-].
constexpr double FALSE_ALARMS = shareOf(assessment_counts::SOUND_ALARMS, assessment_counts::SOUND_RUNS);

/// Errors of WearReadings for flanks and interface, from lives with signals (seeds 11 and 421 of lab/lives_judged.py).
/// In a motion similar to that of a signature, the gain (reading over wear) of the flanks differs by 0.06 among gears.
constexpr ReadingErrors FLANK_READING{ 0.06, 0.012, 0.005, 0.03 };
constexpr ReadingErrors INTERFACE_READING{ 0.2, 0.08, 0.015, 0.03 };
/// Standard deviation of the gain in a motion unlike that of any signature [-]: motion_error of the SignatureSet.
constexpr double OTHER_MOTION_GAIN = 0.25;
/// Mean of true flank wear minus reading, as a severity [-]: the first wear reduces the preload and opens no play. The
/// standard deviation between drives is FLANK_READING.offset.
constexpr double FLANK_SHORT = 0.012;
/// True wear of the interface minus its reading, over the flanks' reading: mean and standard deviation over drives [-].
constexpr double INTERFACE_SHORT = 0.55;
constexpr double FLANK_IN_INTERFACE = 0.2;

}  // namespace assessment_errors

/// Wear of a drive since its reference was learned, estimated from windows, as severities of faults. A wear below the
/// resolution may be negative.
struct WearReading
{
  bool is_read{};          ///< whether wear was measured, which needs a load of both signs and signatures of wear
  double flank{};          ///< severity of tooth_wear [-]
  double interface = 0.0;  ///< severity of interface_wear [-]
  double alike{};          ///< similarity of the motion to the most similar motion of a signature, 0 ... 1 [-]
  double lost_motion{};    ///< lost motion of the windows [rad]
  /// increase of the lost motion per unit of `flank`, at the largest severities of the signatures [rad]
  double lost_motion_slope{};
};

/// Estimates the wear from the mean of the last windows, independently of the verdict.
///
/// Law:   w(s_f) = d_w,   sum over K1, K2 of (k(s_f) + l_k(s_i)) / k_0 = sum of d_k / k_0
/// where  w, k     change of the lost motion and of a stiffness by tooth wear, as functions of its severity s_f
///        l_k      change of a stiffness by interface wear, as a function of its severity s_i. w, k and l_k are means
///                 over the signatures, weighted by the similarity of the motions, and linear between severities
///        d, k_0   difference of the window from the reference; stiffness of the sound drive
/// Only tooth wear counts for the lost motion, because other wear has less than a tenth of the effect of tooth wear.
/// The law adds both stiffnesses, because the share of K1 and K2 in the softening depends on the largest load.
WearReading readWear(const WindowResidual& residual, const OperatingPoint& point, const SignatureSet& set) noexcept;

/// A reading of the wear with the hours of use at the time of the reading.
struct DatedReading
{
  double hours;
  WearReading reading;
};

/// All readings of the wear of a drive.
struct ReadWear
{
  std::vector<DatedReading> readings;    ///< ordered by hours
  double lost_motion_limit{ HUGE_VAL };  ///< measured lost motion at which the drive's use ends [rad]
};

/// Trends of wear from readings and nominal use. `reference_hours`: hours of use at the time of the reference [h].
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
    // The severity of tooth_wear is the mean wear of both flanks, but the limit is for the more worn flank.
    trends.flank_depth = now.mean_flank > 0.0 ? flank * now.flank_wear / now.mean_flank : flank;
    trends.reading_at_end = use.flank().of(at_end * flank) / flank;
  }
  return trends;
}
}  // namespace hjt
