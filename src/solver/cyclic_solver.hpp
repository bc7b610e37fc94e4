// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "elements/ring_sums.hpp"
#include "solver/arc_elimination.hpp"

namespace hjt
{
/// Direct solver for the ring's tangent: symmetric, cyclic, each tooth coupled to two on either side, plus the rank-one
/// cup.
///
/// Four separators of two teeth cut the ring into arcs, which are eliminated side by side (arc_elimination). What is
/// left is dense: the separators and the cup's multiplier, 17 unknowns. Without the cup the ring may turn inside the
/// wave generator almost freely (like a tank's track); pinning the separators keeps the elimination well conditioned,
/// where a rank-one correction afterwards would lose all digits. Of the 17 the cup goes first; while the ring is stable
/// the rest is positive definite and needs no pivoting, else it is done with pivoting. Cost: linear in the number of
/// teeth. No allocation after construction.
class CyclicSolver
{
public:
  /// @param teeth at least 8
  explicit CyclicSolver(int teeth, const arcs::Kernels& kernels = arcs::fastest());

  /// Factors K. False if it is singular or not finite.
  bool factor(const RingTangent& tangent) noexcept;

  /// Solves K x = b in place for the columns of `b` (2 N rows): 1 to 3 of them.
  template <int COLUMNS>
  void solve(Eigen::Matrix<double, Eigen::Dynamic, COLUMNS>& b) noexcept
  {
    static_assert(COLUMNS <= MAX_COLUMNS, "no kernel for so many columns");
    double* columns[COLUMNS];
    for (int c = 0; c < COLUMNS; ++c)
    {
      columns[c] = b.col(c).data();
    }
    solve(columns, COLUMNS);
  }

  /// The same for three right-hand sides of their own.
  void solve(Eigen::VectorXd& a, Eigen::VectorXd& b, Eigen::VectorXd& c) noexcept
  {
    double* columns[MAX_COLUMNS] = { a.data(), b.data(), c.data() };
    solve(columns, MAX_COLUMNS);
  }

private:
  static constexpr int MAX_COLUMNS = 3;
  static constexpr int SCHUR = arcs::SCHUR;
  using SchurComplement = Eigen::Matrix<double, SCHUR, SCHUR, Eigen::RowMajor>;
  using Separators = Eigen::Matrix<double, SCHUR, 1>;
  using SchurWithCup = Eigen::Matrix<double, SCHUR + 1, SCHUR + 1>;
  struct alignas(32) Entry
  {
    double lane[arcs::COUNT];
  };
  using Entries = std::vector<Entry>;

  bool factorSchur(const RingTangent& tangent, const Entry* before, const Entry* after, const Entry* between) noexcept;
  void solveSchur(Separators& x, double& multiplier) const noexcept;
  void solve(double* const* columns, int count) noexcept;

  const arcs::Kernels& kernels_;
  arcs::Layout layout_;
  std::array<int, arcs::COUNT> separator_;  // first tooth of each
  Entries factors_;                         // never empty: their first lanes are handed on
  Entries rows_;
  arcs::SchurFactors schur_;  // of the separators, the cup eliminated
  Separators cup_;            // its column
  double cup_inverse_{};      // and its pivot's inverse
  bool pivoting_{};
  Eigen::PartialPivLU<SchurWithCup> lu_;  // if pivoting
};
}  // namespace hjt
