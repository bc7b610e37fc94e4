// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "gear/ring_shape.hpp"

namespace hjt
{
/// Sum of what the elements of the ring do: minus the gradient of the stored energy.
struct ForceSum
{
  explicit ForceSum(int count) : teeth(2 * count), segment(2 * count) {}

  /// Pulls tooth i with the force of segment i and pushes tooth i+1 with it, for the segments of all solved teeth.
  void addSegmentForces(int solved) noexcept
  {
    const Eigen::Index size = 2 * solved;
    const double* pull = segment.data();
    double* force = teeth.data();
    const double sign = size < teeth.size() ? -1.0 : 1.0;  // of the last segment's pull half a turn on
    force[0] += pull[0] - sign * pull[size - 2];
    force[1] += pull[1] - sign * pull[size - 1];
    for (Eigen::Index k = 2; k < size; ++k)
    {
      force[k] += pull[k] - pull[k - 2];
    }
  }

  /// The whole from the sum over the first half of the ring.
  void repeat() noexcept
  {
    // Forces of the half's end teeth on their neighbours beyond it.
    const Eigen::Index half = teeth.size() / 2;
    teeth.head<2>() -= teeth.segment<2>(half);
    teeth.segment<2>(half - 2) -= teeth.tail<2>();
    repeatHalfTurned(teeth);
    wave_generator_torque *= 2.0;
    output_torque *= 2.0;
    energy *= 2.0;
  }

  /// Sets the sums of the solved teeth and their neighbours to zero.
  void setZero(int solved) noexcept
  {
    teeth.head(std::min<Eigen::Index>(2 * solved + 2, teeth.size())).setZero();
    teeth.tail<2>().setZero();
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
