// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "harmonic_joint_twin/health/baseline.hpp"
#include "harmonic_joint_twin/health/fault_signatures.hpp"

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
}  // namespace hjt
