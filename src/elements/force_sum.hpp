// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace hjt
{
/// Sum of what the elements of the ring do: minus the gradient of the stored energy.
struct ForceSum
{
  explicit ForceSum(int count) : teeth(2 * count), segment(2 * count) {}

  /// Pulls tooth i with the force of segment i and pushes tooth i+1 with it, for all segments.
  void addSegmentForces() noexcept
  {
    const Eigen::Index size = teeth.size();
    const double* pull = segment.data();
    double* force = teeth.data();
    force[0] += pull[0] - pull[size - 2];
    force[1] += pull[1] - pull[size - 1];
    for (Eigen::Index k = 2; k < size; ++k)
    {
      force[k] += pull[k] - pull[k - 2];
    }
  }

  void setZero() noexcept
  {
    teeth.setZero();
    wave_generator_torque = 0.0;
    output_torque = 0.0;
    energy = 0.0;
  }

  Eigen::VectorXd teeth;           ///< 2 N, on the tooth points [N]
  double wave_generator_torque{};  ///< on the wave generator [N.m]
  double output_torque{};          ///< on the circular spline [N.m]
  double energy{};                 ///< stored [J]
  Eigen::VectorXd segment;         ///< 2 N, what an element does along the rim, before `addSegmentForces` [N]
};
}  // namespace hjt
