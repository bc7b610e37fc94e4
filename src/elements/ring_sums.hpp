// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "gear/ring_shape.hpp"

namespace hjt
{
/// Sum over the elements of the ring: minus the gradient of the stored energy, and the energy.
struct ForceSum
{
  explicit ForceSum(int count) : teeth(2 * count), segment(2 * count) {}

  /// Adds the force of segment i to tooth i and subtracts it from tooth i+1, for the segments of all solved teeth.
  void addSegmentForces(int solved) noexcept
  {
    const Eigen::Index size = 2 * solved;
    const double* pull = segment.data();
    double* force = teeth.data();
    const double sign = size < teeth.size() ? -1.0 : 1.0;  // sign of the last segment's force half a turn away
    force[0] += pull[0] - sign * pull[size - 2];
    force[1] += pull[1] - sign * pull[size - 1];
    for (Eigen::Index k = 2; k < size; ++k)
    {
      force[k] += pull[k] - pull[k - 2];
    }
  }

  /// Extends the sum over the first half of the ring to the whole.
  void repeat() noexcept
  {
    // Forces of the half's end teeth on their neighbours in the other half.
    const Eigen::Index half = teeth.size() / 2;
    teeth.head<2>() -= teeth.segment<2>(half);
    teeth.segment<2>(half - 2) -= teeth.tail<2>();
    repeatHalfTurned(teeth);
    wave_generator_torque *= 2.0;
    output_torque *= 2.0;
    energy *= 2.0;
  }

  /// Sets the entries of the solved teeth and their neighbours to zero.
  void setZero(int solved) noexcept
  {
    teeth.head(std::min<Eigen::Index>(2 * solved + 2, teeth.size())).setZero();
    teeth.tail<2>().setZero();
    wave_generator_torque = 0.0;
    output_torque = 0.0;
    energy = 0.0;
  }

  Eigen::VectorXd teeth;           ///< 2 N, forces on the tooth points [N]
  double wave_generator_torque{};  ///< torque on the wave generator [N.m]
  double output_torque{};          ///< torque on the circular spline [N.m]
  double energy{};                 ///< stored energy [J]
  Eigen::VectorXd segment;         ///< 2 N, forces of an element along the rim, before `addSegmentForces` [N]
};

using Block2 = Eigen::Matrix2d;

/// A 2x2 block for each tooth [N/m]. Each entry has its own array, so that loops over the teeth vectorise.
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

/// Symmetric 2x2 blocks, in the same layout.
struct SymmetricBlocks
{
  explicit SymmetricBlocks(int teeth) : xx(teeth), xy(teeth), yy(teeth) {}

  /// Adds a symmetric block.
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

/// Hessian of the stored energy by tooth points, wave generator angle and output angle.
///
/// The part of the teeth is symmetric and cyclic: it couples a tooth with two neighbours on each side, with five 2x2
/// blocks in a row. The cup adds `cup_stiffness * cup_direction * cup_direction^T`, which couples all teeth.
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

  /// Sets the entries of the solved teeth and their neighbours to zero.
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

  /// Adds `block` at (i, j) and its transpose at (j, i), with j = i+1 or i+2, cyclic.
  void addPair(int i, int j, const Block2& block) noexcept
  {
    (j == i + 1 || j == i + 1 - teeth() ? next : second).add(i, block);
  }

  /// Adds the blocks of `segment`: springs between teeth i and i+1, for all solved teeth i.
  void addSegments(int solved) noexcept;

  /// Converts the sum over the first half of the ring to the tangent of this half as a closed ring. Its last teeth are
  /// then coupled to the first ones, which represent the teeth half a turn away with opposite sign.
  void closeHalf() noexcept;

  SymmetricBlocks diagonal;       ///< blocks at (i, i)
  ToothBlocks next;               ///< blocks at (i, i+1), cyclic
  ToothBlocks second;             ///< blocks at (i, i+2), cyclic
  Eigen::VectorXd cup_direction;  ///< 2 N, gradient of the mean rotation [rad/m]
  double cup_stiffness{};         ///< stiffness of the cup for its mean rotation [N.m/rad]
  /// 2 N, mixed derivative of the energy by tooth point and wave generator angle [N/rad]
  Eigen::VectorXd wave_generator;
  Eigen::VectorXd output;             ///< 2 N, mixed derivative of the energy by tooth point and output angle [N/rad]
  double wave_generator_stiffness{};  ///< second derivative of the energy by the wave generator angle [N.m/rad]
  int solved{};                       ///< number of solved teeth: all, or those of the first half
  double output_stiffness{};          ///< second derivative of the energy by the output angle [N.m/rad]
  SymmetricBlocks segment;            ///< tangent of an element between teeth i and i+1, before `addSegments`
};
}  // namespace hjt
