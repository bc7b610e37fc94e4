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
/// Direct solver for the ring's tangent. The tangent is a symmetric cyclic matrix, where each tooth couples to two
/// teeth on each side, plus the rank-one term of the cup.
///
/// Four separators of two teeth each divide the ring into arcs, which are eliminated simultaneously (arc_elimination)
/// while the separators are fixed. A dense system of 17 unknowns remains: 16 of the separators and the cup's
/// multiplier. The multiplier is eliminated first. If the ring is stable, the remaining matrix is positive definite and
/// needs no pivoting. If the ring is unstable, the solver pivots. Without the cup the ring turns almost freely in the
/// wave generator. A rank-one correction for the cup after the elimination would therefore lose all digits. The
/// solver's cost is linear in the number of teeth. Only the constructor allocates.
class CyclicSolver
{
public:
  /// @param teeth number of teeth, at least 8
  explicit CyclicSolver(int teeth, const arcs::Kernels& kernels = arcs::fastest());

  /// Factors the ring's tangent K. @returns false if K is singular or not finite.
  bool factor(const RingTangent& tangent) noexcept;

  /// Solves K x = b for 1 to 3 columns of `b` with two rows for each tooth. The solution replaces `b`.
  template <int COLUMNS>
  void solve(Eigen::Matrix<double, Eigen::Dynamic, COLUMNS>& b) noexcept
  {
    static_assert(COLUMNS <= MAX_COLUMNS, "no kernel for this number of columns");
    double* columns[COLUMNS];
    for (int c = 0; c < COLUMNS; ++c)
    {
      columns[c] = b.col(c).data();
    }
    solve(columns, COLUMNS);
  }

  /// Solves K x = b for three separate right-hand sides. The solutions replace them.
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
  std::array<int, arcs::COUNT> separator_;  // first tooth of each separator
  Entries factors_;                         // factors of the arcs; not empty, as kernels get a pointer to its start
  Entries rows_;
  arcs::SchurFactors schur_;  // factors of the matrix of the separators after elimination of the cup
  Separators cup_;            // column of the cup's multiplier in the matrix of the separators
  double cup_inverse_{};      // inverse of the pivot of the cup's multiplier
  bool pivoting_{};
  Eigen::PartialPivLU<SchurWithCup> lu_;  // factors with pivoting, used if the ring is unstable
};
}  // namespace hjt
