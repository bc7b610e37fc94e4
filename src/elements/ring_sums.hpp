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

using Block2 = Eigen::Matrix2d;

/// A 2x2 block for every tooth, each entry in an array of its own: loops over the teeth then vectorise. [N/m]
struct ToothBlocks
{
  explicit ToothBlocks(int teeth) : xx(teeth), xy(teeth), yx(teeth), yy(teeth) {}

  void add(int i, const Block2& block) noexcept
  {
    xx[i] += block(0, 0);
    xy[i] += block(0, 1);
    yx[i] += block(1, 0);
    yy[i] += block(1, 1);
  }

  Block2 at(int i) const noexcept
  {
    Block2 block;
    block << xx[i], xy[i], yx[i], yy[i];
    return block;
  }

  Eigen::VectorXd xx;
  Eigen::VectorXd xy;
  Eigen::VectorXd yx;
  Eigen::VectorXd yy;
};

/// The same for symmetric blocks.
struct SymmetricBlocks
{
  explicit SymmetricBlocks(int teeth) : xx(teeth), xy(teeth), yy(teeth) {}

  /// Of a symmetric block.
  void add(int i, const Block2& block) noexcept
  {
    xx[i] += block(0, 0);
    xy[i] += block(0, 1);
    yy[i] += block(1, 1);
  }

  Block2 at(int i) const noexcept
  {
    Block2 block;
    block << xx[i], xy[i], xy[i], yy[i];
    return block;
  }

  Eigen::VectorXd xx;
  Eigen::VectorXd xy;
  Eigen::VectorXd yy;
};

/// Hessian of the stored energy over the tooth points, wave generator angle and output angle.
///
/// The tooth part couples a tooth with two neighbours on each side: symmetric, cyclic, five 2x2 blocks a row. The cup
/// adds `cup_stiffness * cup_direction * cup_direction^T`, which couples all teeth.
struct RingTangent
{
  explicit RingTangent(int teeth)
    : diagonal(teeth)
    , next(teeth)
    , second(teeth)
    , cup_direction(2 * teeth)
    , wave_generator(2 * teeth)
    , output(2 * teeth)
    , segment(teeth)
  {
  }

  int teeth() const noexcept { return static_cast<int>(diagonal.xx.size()); }

  void setZero() noexcept { setZero(teeth()); }

  /// Sets the sums of the solved teeth and their neighbours to zero.
  void setZero(int solved_teeth) noexcept
  {
    solved = solved_teeth;
    const int last = teeth() - 1;
    const int count = std::min(solved + 1, teeth());
    for (Eigen::VectorXd* entry : { &diagonal.xx, &diagonal.xy, &diagonal.yy, &next.xx, &next.xy, &next.yx, &next.yy,
                                    &second.xx, &second.xy, &second.yx, &second.yy })
    {
      entry->head(count).setZero();
      (*entry)[last] = 0.0;
    }
    for (Eigen::VectorXd* vector : { &cup_direction, &wave_generator, &output })
    {
      vector->head(2 * count).setZero();
      vector->tail<2>().setZero();
    }
    cup_stiffness = 0.0;
    wave_generator_stiffness = 0.0;
    output_stiffness = 0.0;
  }

  void addDiagonal(int i, const Block2& block) noexcept { diagonal.add(i, block); }

  /// Adds `block` at (i, j) and its transpose at (j, i); j is i+1 or i+2, cyclic.
  void addPair(int i, int j, const Block2& block) noexcept
  {
    (j == i + 1 || j == i + 1 - teeth() ? next : second).add(i, block);
  }

  /// Adds the blocks of `segment`: springs between teeth i and i+1, i all solved teeth.
  void addSegments(int solved) noexcept;

  /// Of the sum over the first half of the ring, the tangent that this half has as a ring of its own: its last teeth
  /// are coupled to the first, which stand half a turn on at the points reversed.
  void closeHalf() noexcept;

  SymmetricBlocks diagonal;           ///< at (i, i)
  ToothBlocks next;                   ///< at (i, i+1), cyclic
  ToothBlocks second;                 ///< at (i, i+2), cyclic
  Eigen::VectorXd cup_direction;      ///< 2 N, gradient of the mean rotation [rad/m]
  double cup_stiffness{};             ///< [N.m/rad]
  Eigen::VectorXd wave_generator;     ///< 2 N, mixed derivative of the energy by tooth and wave generator angle [N/rad]
  Eigen::VectorXd output;             ///< 2 N, the same by output angle [N/rad]
  double wave_generator_stiffness{};  ///< second derivative by the wave generator angle [N.m/rad]
  int solved{};                       ///< teeth of the ring that it is of: all, or the first half
  double output_stiffness{};          ///< second derivative by the output angle [N.m/rad]
  SymmetricBlocks segment;            ///< an element's tangent between teeth i and i+1, before `addSegments`
};
}  // namespace hjt
