// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "elements/flank_contact.hpp"

namespace hjt
{
/// Sum of what the elements do, minus the gradient of the stored energy, with the contacts it came from.
/// Elements read their own entries again for the tangent at the same shape.
struct RingForces
{
  explicit RingForces(int teeth)
    : teeth(2 * teeth)
    , contact_force(teeth)
    , contact_depth(teeth)
    , contact_curvature(teeth)
    , contact_normal(2 * teeth)
    , gap(teeth)
    , gap_rate(teeth)
    , gap_second(teeth)
    , flank_force(teeth)
    , meshed(teeth)
    , flanks(teeth)
    , pressed(teeth)
    , bending_moment(teeth)
    , segment(2 * teeth)
  {
  }

  /// Pulls tooth i with the force of segment i and pushes tooth i+1 with it, for all segments.
  void addSegmentForces() noexcept
  {
    const int n = static_cast<int>(flank_force.size());
    const double* pull = segment.data();
    double* force = teeth.data();
    force[0] += pull[0] - pull[2 * n - 2];
    force[1] += pull[1] - pull[2 * n - 1];
    for (int k = 2; k < 2 * n; ++k)
    {
      force[k] += pull[k] - pull[k - 2];
    }
  }

  void setZero() noexcept
  {
    teeth.setZero();
    flank_force.setZero();
    std::fill(meshed.begin(), meshed.end(), 0);
    flanks.clear();
    wave_generator_torque = 0.0;
    output_torque = 0.0;
    energy = 0.0;
  }

  Eigen::VectorXd teeth;              ///< 2 N, on the tooth points [N]
  double wave_generator_torque{};     ///< on the wave generator [N.m]
  double output_torque{};             ///< on the circular spline [N.m]
  double energy{};                    ///< stored [J]
  Eigen::VectorXd contact_force;      ///< N, normal force of the wave generator on each tooth, >= 0 [N]
  Eigen::VectorXd contact_depth;      ///< N, depth of each tooth point inside the wave generator, less the gap [m]
  Eigen::VectorXd contact_curvature;  ///< N, of the wave generator there [1/m]
  Eigen::VectorXd contact_normal;     ///< 2 N, its direction, outward [-]
  Eigen::VectorXd gap;                ///< N, while the bearing is faulty: between wave generator and rim [m]
  Eigen::VectorXd gap_rate;           ///< N, likewise: its derivative by the wave generator's angle [m/rad]
  Eigen::VectorXd gap_second;         ///< N, likewise: the second derivative [m/rad^2]
  Eigen::VectorXd flank_force;        ///< N, normal force on the flank; > 0 leading, < 0 trailing flank [N]
  std::vector<char> meshed;           ///< N, tooth touches a flank [-]
  FlankContacts flanks;               ///< the teeth that touch, with what the mesh found
  Eigen::VectorXd pressed;            ///< N, depth of each tooth in the nearer flank, across; touching if > 0 [m]
  Eigen::VectorXd
      bending_moment;       ///< N, moment of the rim's bending at each tooth (absolute law: on each segment) [N.m]
  double cup_rotation{};    ///< mean rotation of the tooth points [rad]
  Eigen::VectorXd segment;  ///< 2 N, what an element does along the rim, before `addSegmentForces` [N]
};

using Block2 = Eigen::Matrix2d;

/// A 2x2 block for every tooth, each entry in an array of its own: loops over the teeth then vectorise. [N/m]
struct ToothBlocks
{
  explicit ToothBlocks(int teeth) : xx(teeth), xy(teeth), yx(teeth), yy(teeth) {}

  void setZero() noexcept
  {
    xx.setZero();
    xy.setZero();
    yx.setZero();
    yy.setZero();
  }

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

  void setZero() noexcept
  {
    xx.setZero();
    xy.setZero();
    yy.setZero();
  }

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
/// The tooth part couples a tooth with two neighbours on each side: symmetric, cyclic, five 2x2 blocks a row. The cup adds
/// `cup_stiffness * cup_direction * cup_direction^T`, which couples all teeth.
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

  void setZero() noexcept
  {
    diagonal.setZero();
    next.setZero();
    second.setZero();
    cup_direction.setZero();
    cup_stiffness = 0.0;
    wave_generator.setZero();
    output.setZero();
    wave_generator_stiffness = 0.0;
    output_stiffness = 0.0;
  }

  void addDiagonal(int i, const Block2& block) noexcept { diagonal.add(i, block); }

  /// Adds `block` at (i, j) and its transpose at (j, i); j is i+1 or i+2, cyclic.
  void addPair(int i, int j, const Block2& block) noexcept
  {
    (j == i + 1 || j == i + 1 - teeth() ? next : second).add(i, block);
  }

  /// Adds the blocks of `segment`: springs between teeth i and i+1.
  void addSegments() noexcept;

  SymmetricBlocks diagonal;           ///< at (i, i)
  ToothBlocks next;                   ///< at (i, i+1), cyclic
  ToothBlocks second;                 ///< at (i, i+2), cyclic
  Eigen::VectorXd cup_direction;      ///< 2 N, gradient of the mean rotation [rad/m]
  double cup_stiffness{};             ///< [N.m/rad]
  Eigen::VectorXd wave_generator;     ///< 2 N, mixed derivative of the energy by tooth and wave generator angle [N/rad]
  Eigen::VectorXd output;             ///< 2 N, the same by output angle [N/rad]
  double wave_generator_stiffness{};  ///< second derivative by the wave generator angle [N.m/rad]
  double output_stiffness{};          ///< second derivative by the output angle [N.m/rad]
  SymmetricBlocks segment;            ///< what an element does between teeth i and i+1, before `addSegments`
};
}  // namespace hjt
