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
  explicit BorderedRingSolver(int teeth);

  /// Factors. `held`: wave generator, output; a held angle's solution is zero. False if singular or not finite.
  bool factor(const RingTangent& tangent, const std::array<bool, 2>& held) noexcept;

  /// Solves in place: 2 N of the teeth, wave generator, output.
  void solve(Eigen::VectorXd& b) noexcept;

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
