// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace hjt
{
/// Least squares over a stream, by its normal equations; memory does not grow with the rows.
///
/// Law:   minimise  sum w (y - x . b)^2 + ridge
/// where  x, y  row of the design and its targets;  b  coefficients, one column per target
///        w     weight as given to `add`, times the shares that `forget` kept since
/// Columns are scaled to unit mean square before the factorisation. The ridge, 1e-6 of that, only matters where columns
/// depend on each other: their coefficients are then shared, and `inflation` shows it.
class RunningRegression
{
public:
  RunningRegression(int columns, int targets);

  void reset() noexcept;
  void forget(double kept) noexcept;
  /// `weight`: inverse of the variance, relative to that of a row of weight 1 [-].
  void add(const Eigen::Ref<const Eigen::VectorXd>& row, const Eigen::Ref<const Eigen::VectorXd>& targets,
           double weight = 1.0) noexcept;

  /// Changes the sums as if `share` times the other column had been subtracted from the column in every row.
  void subtract(int column, int other, double share) noexcept;
  /// Changes the sums as if the column had been zero in every row: its coefficient is then 0.
  void drop(int column) noexcept;
  /// Mean of the product of two columns [-].
  double mean(int column, int other) const noexcept;

  /// Fits with the first `used` columns. False: too few rows, or not solvable; the coefficients are then as before.
  bool fit(int used) noexcept;

  double rows() const noexcept { return rows_; }  ///< number of rows, minus the weight of forgotten rows [-]

  // Results of the last fit.
  double coefficient(int column, int target) const noexcept { return coefficients_(column, target); }
  Eigen::Ref<const Eigen::VectorXd> coefficients(int target) const noexcept { return coefficients_.col(target); }
  double standardError(int column, int target) const noexcept;
  /// Variance of a coefficient over what it would be if its column stood alone; 1: independent of the others [-].
  double inflation(int column) const noexcept { return inverse_diagonal_[column]; }

private:
  double& moment(int column, int other) noexcept;  // moment of the two columns, from the lower triangle

  double rows_{};
  double weight_{};
  Eigen::MatrixXd normal_;   // sum x x', of which the lower triangle counts
  Eigen::MatrixXd moments_;  // sum x y'
  Eigen::VectorXd squares_;  // sum y^2
  Eigen::VectorXd scale_;    // scales of the columns at the last fit
  Eigen::MatrixXd factor_;
  Eigen::MatrixXd inverse_;  // of the factor
  Eigen::VectorXd inverse_diagonal_;
  Eigen::MatrixXd coefficients_;
  Eigen::VectorXd spread_;  // standard deviation of each target's residuals
  double fitted_rows_{ 1.0 };
};
}  // namespace hjt
