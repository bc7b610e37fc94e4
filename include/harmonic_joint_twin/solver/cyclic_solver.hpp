// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "harmonic_joint_twin/elements/ring_forces.hpp"
#include "harmonic_joint_twin/solver/arc_elimination.hpp"

namespace hjt
{
/// Direct solver for the ring's tangent: symmetric, cyclic, each tooth coupled to two on either side, plus the rank-one
/// cup.
///
/// Four separators of two teeth cut the ring into arcs, which are eliminated side by side (arc_elimination). What is left
/// is dense: the separators and the cup's multiplier, 17 unknowns, with pivoting. Without the cup the ring may turn
/// inside the wave generator almost freely (like a tank's track); pinning the separators keeps the elimination well
/// conditioned, where a rank-one correction afterwards would lose all digits.
/// Cost: linear in the number of teeth. No allocation after construction.
class CyclicSolver
{
public:
  /// @param teeth at least 8
  explicit CyclicSolver(int teeth, const arcs::Kernels& kernels = arcs::fastest());

  /// Factors K. False if it is singular or not finite.
  bool factor(const RingTangent& tangent) noexcept;

  /// Solves K x = b in place for the columns of `b` (2 N rows, row-major): 1 to 3 of them.
  template <int COLUMNS>
  void solve(
      Eigen::Matrix<double, Eigen::Dynamic, COLUMNS, COLUMNS == 1 ? Eigen::ColMajor : Eigen::RowMajor>& b) noexcept
  {
    static_assert(COLUMNS <= MAX_COLUMNS, "no kernel for so many columns");
    solve(b.data(), COLUMNS);
  }

private:
  static constexpr int MAX_COLUMNS = 3;
  static constexpr int SEPARATORS = 4 * arcs::COUNT;  // their unknowns, 4 each
  static constexpr int CORNER = SEPARATORS + 1;       // and the cup's multiplier
  using Corner = Eigen::Matrix<double, CORNER, CORNER>;
  struct alignas(32) Entry
  {
    double lane[arcs::COUNT];
  };
  using Entries = std::vector<Entry>;

  void solve(double* b, int columns) noexcept;

  const arcs::Kernels& kernels_;
  arcs::Layout layout_;
  std::array<int, arcs::COUNT> separator_;  // first tooth of each
  Entries factors_;
  Entries rows_;
  Eigen::PartialPivLU<Corner> corner_;
};
}  // namespace hjt
