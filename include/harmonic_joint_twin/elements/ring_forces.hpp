// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

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
    , flank_force(teeth)
    , meshed(teeth)
    , bending_moment(teeth)
  {
  }

  void setZero() noexcept
  {
    teeth.setZero();
    flank_force.setZero();
    std::fill(meshed.begin(), meshed.end(), 0);
    wave_generator_torque = 0.0;
    output_torque = 0.0;
    energy = 0.0;
  }

  Eigen::VectorXd teeth;              ///< 2 N, on the tooth points [N]
  double wave_generator_torque{};     ///< on the wave generator [N.m]
  double output_torque{};             ///< on the circular spline [N.m]
  double energy{};                    ///< stored [J]
  Eigen::VectorXd contact_force;      ///< N, normal force of the wave generator on each tooth, >= 0 [N]
  Eigen::VectorXd contact_depth;      ///< N, depth of each tooth point inside the wave generator [m]
  Eigen::VectorXd contact_curvature;  ///< N, of the wave generator there [1/m]
  Eigen::VectorXd contact_normal;     ///< 2 N, its direction, outward [-]
  Eigen::VectorXd flank_force;        ///< N, normal force on the flank; > 0 leading, < 0 trailing flank [N]
  std::vector<char> meshed;           ///< N, tooth touches a flank [-]
  Eigen::VectorXd
      bending_moment;     ///< N, moment of the rim's bending at each tooth (absolute law: on each segment) [N.m]
  double cup_rotation{};  ///< mean rotation of the tooth points [rad]
};

using Block2 = Eigen::Matrix2d;
using Block4 = Eigen::Matrix4d;

/// Hessian of the stored energy over the tooth points, wave generator angle and output angle.
///
/// The tooth part couples a tooth with two neighbours on each side. Teeth in pairs make it cyclic block-tridiagonal
/// with 4x4 blocks, symmetric; the cup adds `cup_stiffness * cup_direction * cup_direction^T`, which couples all teeth.
struct RingTangent
{
  explicit RingTangent(int teeth)
    : diagonal(teeth / 2), upper(teeth / 2), cup_direction(2 * teeth), wave_generator(2 * teeth), output(2 * teeth)
  {
  }

  int pairs() const noexcept { return static_cast<int>(diagonal.size()); }

  void setZero() noexcept
  {
    for (int p = 0; p < pairs(); ++p)
    {
      diagonal[p].setZero();
      upper[p].setZero();
    }
    cup_direction.setZero();
    cup_stiffness = 0.0;
    wave_generator.setZero();
    output.setZero();
    wave_generator_stiffness = 0.0;
    output_stiffness = 0.0;
  }

  void addDiagonal(int i, const Block2& block) noexcept
  {
    diagonal[i / 2].block<2, 2>(2 * (i & 1), 2 * (i & 1)) += block;
  }

  /// Adds `block` at (i, j) and its transpose at (j, i); j is i+1 or i+2, cyclic.
  void addPair(int i, int j, const Block2& block) noexcept
  {
    if (i / 2 == j / 2)
    {
      diagonal[i / 2].block<2, 2>(2 * (i & 1), 2 * (j & 1)) += block;
      diagonal[i / 2].block<2, 2>(2 * (j & 1), 2 * (i & 1)) += block.transpose();
    }
    else
    {
      upper[i / 2].block<2, 2>(2 * (i & 1), 2 * (j & 1)) += block;
    }
  }

  std::vector<Block4, Eigen::aligned_allocator<Block4>> diagonal;  ///< N/2 [N/m]
  std::vector<Block4, Eigen::aligned_allocator<Block4>> upper;     ///< N/2, pair p to p+1, cyclic [N/m]
  Eigen::VectorXd cup_direction;                                   ///< 2 N, gradient of the mean rotation [rad/m]
  double cup_stiffness{};                                          ///< [N.m/rad]
  Eigen::VectorXd wave_generator;     ///< 2 N, mixed derivative of the energy by tooth and wave generator angle [N/rad]
  Eigen::VectorXd output;             ///< 2 N, the same by output angle [N/rad]
  double wave_generator_stiffness{};  ///< second derivative by the wave generator angle [N.m/rad]
  double output_stiffness{};          ///< second derivative by the output angle [N.m/rad]
};
}  // namespace hjt
