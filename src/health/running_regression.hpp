// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace hjt
{
/// Least squares over a stream of rows by the normal equations, in memory that does not grow with the rows.
///
/// Law:   minimise  sum w (y - x . b)^2 + ridge
/// where  x, y  row of the design and its targets;  b  coefficients, one column per target
///        w     weight given to `add`, times the argument of each later call of `forget`
/// Columns are scaled to unit mean square before the factorisation. The ridge is 1e-6. The ridge matters only for
/// columns that depend on each other: it divides their effect among their coefficients, and their `inflation` is large.
class RunningRegression
{
public:
  RunningRegression(int columns, int targets);

  void reset() noexcept;
  void forget(double kept) noexcept;  ///< multiplies all weights by `kept` [-]
  /// Adds a row. `weight`: inverse of the variance of the row's errors, relative to a row of weight 1 [-].
  void add(const Eigen::Ref<const Eigen::VectorXd>& row, const Eigen::Ref<const Eigen::VectorXd>& targets,
           double weight = 1.0) noexcept;

  /// Changes the sums as if `share` times column `other` had been subtracted from `column` in every row.
  void subtract(int column, int other, double share) noexcept;
  /// Changes the sums as if the column had been zero in every row. The coefficient of the column is then 0.
  void drop(int column) noexcept;
  /// Mean over the rows of the product of two columns, in the product of their units.
  double mean(int column, int other) const noexcept;

  /// Fits the first `used` columns. If rows are too few or the fit is singular, returns false and keeps the last fit.
  bool fit(int used) noexcept;

  double rows() const noexcept { return rows_; }  ///< number of rows, where `forget` reduces the count of old rows [-]

  // Results of the last fit.
  double coefficient(int column, int target) const noexcept { return coefficients_(column, target); }
  Eigen::Ref<const Eigen::VectorXd> coefficients(int target) const noexcept { return coefficients_.col(target); }
  double standardError(int column, int target) const noexcept;
  /// Variance of a coefficient over its variance in a fit of its column alone; 1: independent of other columns [-].
  double inflation(int column) const noexcept { return inverse_diagonal_[column]; }

private:
  double& moment(int column, int other) noexcept;  // sum of the products of two columns, from the lower triangle

  double rows_{};
  double weight_{};
  Eigen::MatrixXd normal_;   // sum x x', of which the lower triangle counts
  Eigen::MatrixXd moments_;  // sum x y'
  Eigen::VectorXd squares_;  // sum y^2
  Eigen::VectorXd scale_;    // scales of the columns at the last fit
  Eigen::MatrixXd factor_;
  Eigen::MatrixXd inverse_;  // inverse of the factor
  Eigen::VectorXd inverse_diagonal_;
  Eigen::MatrixXd coefficients_;
  Eigen::VectorXd spread_;  // standard deviation of each target's residuals
  double fitted_rows_{ 1.0 };
};
}  // namespace hjt
