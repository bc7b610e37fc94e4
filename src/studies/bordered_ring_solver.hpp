// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include "solver/cyclic_solver.hpp"

namespace hjt
{
/// Direct solver for the ring's tangent over all coordinates: the cyclic tooth part bordered by the two angles, which
/// are condensed to 2 x 2 by two more right-hand sides. No allocation after construction.
class BorderedRingSolver
{
public:
  explicit BorderedRingSolver(int teeth)
    : teeth_(teeth), border_(2 * teeth, 2), condensed_(2 * teeth, 2), scratch_(2 * teeth)
  {
  }

  /// Factors. `held`: wave generator, output; a held angle's solution is zero. False if singular or not finite.
  bool factor(const RingTangent& tangent, const std::array<bool, 2>& held) noexcept
  {
    held_ = held;
    if (!teeth_.factor(tangent))
    {
      return false;
    }
    if (held_[0] && held_[1])
    {
      return true;
    }
    border_.col(0) = tangent.wave_generator;
    border_.col(1) = tangent.output;
    condensed_ = border_;
    teeth_.solve<2>(condensed_);
    Eigen::Matrix2d corner = -border_.transpose() * condensed_;
    corner(0, 0) += tangent.wave_generator_stiffness;
    corner(1, 1) += tangent.output_stiffness;
    for (int k = 0; k < 2; ++k)
    {
      if (held_[static_cast<std::size_t>(k)])
      {
        corner.row(k).setZero();
        corner.col(k).setZero();
        corner(k, k) = 1.0;
      }
    }
    corner_inverse_ = corner.inverse();
    return corner_inverse_.allFinite();
  }

  /// Solves in place: 2 N of the teeth, wave generator, output.
  void solve(Eigen::VectorXd& b) noexcept
  {
    scratch_ = b.head(scratch_.size());
    teeth_.solve<1>(scratch_);
    if (held_[0] && held_[1])
    {
      b.tail<2>().setZero();
    }
    else
    {
      Eigen::Vector2d angles = b.tail<2>() - border_.transpose() * scratch_;
      for (int k = 0; k < 2; ++k)
      {
        angles[k] = held_[static_cast<std::size_t>(k)] ? 0.0 : angles[k];
      }
      angles = corner_inverse_ * angles;
      scratch_.noalias() -= condensed_ * angles;
      b.tail<2>() = angles;
    }
    b.head(scratch_.size()) = scratch_;
  }

private:
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 2>;

  CyclicSolver teeth_;
  std::array<bool, 2> held_{};
  Columns border_;     // tooth part by the angles
  Columns condensed_;  // teeth_^-1 border_
  Eigen::Matrix2d corner_inverse_{ Eigen::Matrix2d::Identity() };
  Eigen::VectorXd scratch_;
};
}  // namespace hjt
