// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "harmonic_joint_twin/health/ageing_laws.hpp"
#include "harmonic_joint_twin/health/drive_age.hpp"
#include "harmonic_joint_twin/twin/duty_cycle.hpp"

namespace hjt
{
/// The drive with the wear of its age, as faults of its parameters.
Parameters wornDrive(const Parameters& parameters, const DriveAge& age);

/// The bridge between seconds and years: what each phase of a duty cycle does to the drive, measured on the tooth model at
/// some stages of wear, bilinear between them.
class ExposureMap
{
public:
  /// Solves the tooth model at every stage (some seconds). `positions`: wave generator angles per tooth pitch.
  /// @throws ParameterError where the ring has no equilibrium.
  ExposureMap(const Parameters& parameters, const DutyCycle& duty, int positions,
              const std::function<void(double)>& progress);

  /// Of one phase at a stage of wear; beyond the limits of wear that at the limits.
  Exposure at(std::size_t phase, double flank_wear, double interface_wear) const;

  /// Largest difference to the tooth model itself in the middle of all cells, over the largest value of the same quantity in
  /// any phase [-]. Slow.
  double largestError(const Parameters& parameters, const DutyCycle& duty, int positions) const;

private:
  static constexpr int STAGES = 4;  // of each kind of wear, the new drive and the limit included
  static std::size_t place(std::size_t phase, int flank, int interface)
  {
    return (phase * STAGES + static_cast<std::size_t>(flank)) * STAGES + static_cast<std::size_t>(interface);
  }

  double flank_step_;      // [m]
  double interface_step_;  // [m]
  std::vector<Exposure> nodes_;
};
}  // namespace hjt
