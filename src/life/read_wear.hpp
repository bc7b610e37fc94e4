// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "harmonic_joint_twin/health/baseline.hpp"
#include "harmonic_joint_twin/health/fault_signatures.hpp"
#include "life/assessment_errors.hpp"
#include "life/drive_age.hpp"
#include "life/nominal_use.hpp"
#include "life/wear_trend.hpp"

namespace hjt
{
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
