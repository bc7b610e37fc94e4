// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "gear/ring_shape.hpp"

namespace hjt
{
/// Stored energy of all elements of the ring, and minus its gradient, the forces.
struct ForceSum
{
  explicit ForceSum(int count) : teeth(2 * count), segment(2 * count) {}

  /// Adds the force of segment i to tooth i and subtracts it from tooth i+1, for the segments of all solved teeth.
  void addSegmentForces(int solved) noexcept
  {
    const Eigen::Index size = 2 * solved;
    const double* pull = segment.data();
    double* force = teeth.data();
    const double sign = size < teeth.size() ? -1.0 : 1.0;  // a force half a turn away has the opposite sign
    force[0] += pull[0] - sign * pull[size - 2];
    force[1] += pull[1] - sign * pull[size - 1];
    for (Eigen::Index k = 2; k < size; ++k)
    {
      force[k] += pull[k] - pull[k - 2];
    }
  }

  /// Extends the sum over the first half of the ring to the whole ring.
  void repeat() noexcept
  {
    // This half loads the first and the last tooth of the other half. The teeth half a turn away get these forces.
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

  Eigen::VectorXd teeth;           ///< force on each tooth point, x and y [N]
  double wave_generator_torque{};  ///< torque on the wave generator [N.m]
  double output_torque{};          ///< torque on the circular spline [N.m]
  double energy{};                 ///< stored energy [J]
  Eigen::VectorXd segment;         ///< force of one element on the start of each segment, x and y [N]
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

/// A symmetric 2x2 block for each tooth [N/m], with an array for each entry as in ToothBlocks.
struct SymmetricBlocks
{
  explicit SymmetricBlocks(int teeth) : xx(teeth), xy(teeth), yy(teeth) {}

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
/// The part of the tooth points is symmetric and cyclic. It couples a tooth with two neighbours on each side, so that a
/// row has five 2x2 blocks. The cup adds `cup_stiffness * cup_direction * cup_direction^T`, which couples all teeth.
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

  /// Adds `block` for the teeth (i, j) and its transpose for (j, i), where j is i+1 or i+2, modulo the number of teeth.
  void addPair(int i, int j, const Block2& block) noexcept
  {
    (j == i + 1 || j == i + 1 - teeth() ? next : second).add(i, block);
  }

  /// Adds the blocks of `segment` for all solved teeth i: stiffness of the segment between the teeth i and i+1.
  void addSegments(int solved) noexcept;

  /// Converts the sum over the first half of the ring to the tangent of this half as a closed ring. The last teeth of
  /// the half are then coupled to its first teeth, which represent the teeth half a turn away with opposite sign.
  void closeHalf() noexcept;

  SymmetricBlocks diagonal;       ///< block of each tooth i with itself
  ToothBlocks next;               ///< block of each tooth i with tooth i+1, cyclic
  ToothBlocks second;             ///< block of each tooth i with tooth i+2, cyclic
  Eigen::VectorXd cup_direction;  ///< gradient of the mean rotation by x and y of each tooth point [rad/m]
  double cup_stiffness{};         ///< stiffness of the cup for its mean rotation [N.m/rad]
  /// mixed derivative of the energy by x and y of each tooth point and the wave generator angle [N/rad]
  Eigen::VectorXd wave_generator;
  Eigen::VectorXd output;             ///< mixed derivative of the energy by x, y and the output angle [N/rad]
  double wave_generator_stiffness{};  ///< second derivative of the energy by the wave generator angle [N.m/rad]
  int solved{};                       ///< number of solved teeth: all teeth, or those of the first half
  double output_stiffness{};          ///< second derivative of the energy by the output angle [N.m/rad]
  SymmetricBlocks segment;            ///< stiffness between the teeth i and i+1 by one element, before `addSegments`
};
}  // namespace hjt
