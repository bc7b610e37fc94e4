// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "harmonic_joint_twin/elements/ring_forces.hpp"

namespace hjt
{
/// Direct solver for the ring's tangent: symmetric, cyclic block-tridiagonal with 4x4 blocks, plus the rank-one cup.
///
/// The last block and the cup's multiplier form a border of width 5 that every other block couples to. Without the cup
/// the ring may turn inside the wave generator almost freely (like a tank's track); pinning the last block in the border
/// keeps the elimination well conditioned, where a rank-one correction afterwards would lose all digits.
/// Cost: linear in the number of teeth. No allocation after construction.
class CyclicSolver
{
public:
  explicit CyclicSolver(int teeth);

  /// Factors K. False if it is singular or not finite.
  bool factor(const RingTangent& tangent) noexcept;

  /// Solves K x = b in place for the columns of `b` (2 N rows, row-major so that a block is contiguous).
  template <int COLUMNS>
  void solve(Eigen::Matrix<double, Eigen::Dynamic, COLUMNS, COLUMNS == 1 ? Eigen::ColMajor : Eigen::RowMajor>& b)
      const noexcept;

private:
  static constexpr int BORDER = 5;
  using Border = Eigen::Matrix<double, 4, BORDER>;
  using Corner = Eigen::Matrix<double, BORDER, BORDER>;
  template <class T>
  using Blocks = std::vector<T, Eigen::aligned_allocator<T>>;

  int last_;
  Blocks<Block4> inverse_;  // of the eliminated diagonal blocks
  Blocks<Block4> upper_;    // inverse times coupling to the next block
  Blocks<Border> border_;   // inverse times coupling to the border
  Corner corner_inverse_;
};

template <int COLUMNS>
void CyclicSolver::solve(
    Eigen::Matrix<double, Eigen::Dynamic, COLUMNS, COLUMNS == 1 ? Eigen::ColMajor : Eigen::RowMajor>& b) const noexcept
{
  Eigen::Matrix<double, BORDER, COLUMNS> end;
  end.template topRows<4>() = b.template middleRows<4>(4 * last_);
  end.template bottomRows<1>().setZero();
  for (int p = 0; p < last_; ++p)
  {
    const Eigen::Matrix<double, 4, COLUMNS> row = b.template middleRows<4>(4 * p);
    end.noalias() -= border_[p].transpose() * row;
    if (p + 1 < last_)
    {
      b.template middleRows<4>(4 * (p + 1)).noalias() -= upper_[p].transpose() * row;
    }
  }
  const Eigen::Matrix<double, BORDER, COLUMNS> x_end = corner_inverse_ * end;
  b.template middleRows<4>(4 * last_) = x_end.template topRows<4>();
  Eigen::Matrix<double, 4, COLUMNS> x = Eigen::Matrix<double, 4, COLUMNS>::Zero();
  for (int p = last_ - 1; p >= 0; --p)
  {
    Eigen::Matrix<double, 4, COLUMNS> value = inverse_[p] * b.template middleRows<4>(4 * p);
    value.noalias() -= border_[p] * x_end;
    value.noalias() -= upper_[p] * x;
    b.template middleRows<4>(4 * p) = value;
    x = value;
  }
}
}  // namespace hjt
