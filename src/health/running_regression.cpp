// SPDX-License-Identifier: BSD-3-Clause
#include "health/running_regression.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>

#include "gear/vector_loops.hpp"

namespace hjt
{
namespace
{
// Ridge as a share of a column's mean square [-]. A column that differs from other columns by less than a thousandth
// gets no separate coefficient, for example the column of a nearly constant speed beside the column of ones.
constexpr double RIDGE = 1e-6;

/// Adds weight row row' to a square matrix that is stored by columns. The sums are valid in the lower triangle only; a
/// loop over whole vectors also writes a few elements above the triangle.
HJT_VECTOR_CLONES void addSquare(const double* __restrict__ row, int order, double weight,
                                 double* __restrict__ square) noexcept
{
  constexpr int VECTOR = 8;
  for (int column = 0; column < order; ++column)
  {
    const double factor = weight * row[column];
    double* __restrict__ sums = square + static_cast<std::ptrdiff_t>(column) * order;
#pragma omp simd
    for (int i = column & -VECTOR; i < order; ++i)
    {
      sums[i] += factor * row[i];
    }
  }
}
}  // namespace

RunningRegression::RunningRegression(int columns, int targets)
  : normal_(Eigen::MatrixXd::Zero(columns, columns))
  , moments_(Eigen::MatrixXd::Zero(columns, targets))
  , squares_(Eigen::VectorXd::Zero(targets))
  , scale_(Eigen::VectorXd::Zero(columns))
  , factor_(Eigen::MatrixXd::Zero(columns, columns))
  , inverse_(Eigen::MatrixXd::Zero(columns, columns))
  , inverse_diagonal_(Eigen::VectorXd::Zero(columns))
  , coefficients_(Eigen::MatrixXd::Zero(columns, targets))
  , spread_(Eigen::VectorXd::Zero(targets))
{
}

void RunningRegression::reset() noexcept
{
  rows_ = 0.0;
  weight_ = 0.0;
  normal_.setZero();
  moments_.setZero();
  squares_.setZero();
}

void RunningRegression::forget(double kept) noexcept
{
  rows_ *= kept;
  weight_ *= kept;
  normal_ *= kept;
  moments_ *= kept;
  squares_ *= kept;
}

void RunningRegression::add(const Eigen::Ref<const Eigen::VectorXd>& row,
                            const Eigen::Ref<const Eigen::VectorXd>& targets, double weight) noexcept
{
  rows_ += 1.0;
  weight_ += weight;
  addSquare(row.data(), static_cast<int>(row.size()), weight, normal_.data());
  for (Eigen::Index target = 0; target < targets.size(); ++target)
  {
    const double weighted = weight * targets[target];
    moments_.col(target) += weighted * row;
    squares_[target] += weighted * targets[target];
  }
}

double& RunningRegression::moment(int column, int other) noexcept
{
  return normal_(std::max(column, other), std::min(column, other));
}

double RunningRegression::mean(int column, int other) const noexcept
{
  return normal_(std::max(column, other), std::min(column, other)) / weight_;
}

void RunningRegression::subtract(int column, int other, double share) noexcept
{
  const double own =
      moment(column, column) - 2.0 * share * moment(column, other) + share * share * moment(other, other);
  for (int i = 0; i < normal_.rows(); ++i)
  {
    moment(column, i) -= share * moment(other, i);
  }
  moment(column, column) = own;
  moments_.row(column) -= share * moments_.row(other);
}

void RunningRegression::drop(int column) noexcept
{
  for (int i = 0; i < normal_.rows(); ++i)
  {
    moment(column, i) = 0.0;
  }
  moments_.row(column).setZero();
}

bool RunningRegression::fit(int used) noexcept
{
  if (rows_ <= used)
  {
    return false;
  }
  // Column i times scale_[i] has mean square 1. A column of zeros stays zero, and the ridge makes its coefficient 0.
  for (int i = 0; i < used; ++i)
  {
    scale_[i] = normal_(i, i) > 0.0 ? std::sqrt(rows_ / normal_(i, i)) : 1.0;
  }
  for (int j = 0; j < used; ++j)
  {
    for (int i = j; i < used; ++i)
    {
      factor_(i, j) = normal_(i, j) * scale_[i] * scale_[j] / rows_;
    }
    factor_(j, j) += RIDGE;
  }
  Eigen::Ref<Eigen::MatrixXd> block = factor_.topLeftCorner(used, used);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(block);
  if (cholesky.info() != Eigen::Success)
  {
    return false;
  }
  fitted_rows_ = rows_;
  // Inverse of the factor, column by column. Sums of squares of its entries are the diagonal of the matrix's inverse.
  inverse_diagonal_.setZero();
  for (int j = 0; j < used; ++j)
  {
    for (int i = j; i < used; ++i)
    {
      double sum = i == j ? 1.0 : 0.0;
      for (int k = j; k < i; ++k)
      {
        sum -= factor_(i, k) * inverse_(k, j);
      }
      inverse_(i, j) = sum / factor_(i, i);
      inverse_diagonal_[j] += inverse_(i, j) * inverse_(i, j);
    }
  }
  coefficients_.setZero();
  for (Eigen::Index target = 0; target < coefficients_.cols(); ++target)
  {
    auto solution = coefficients_.col(target).head(used);
    solution = moments_.col(target).head(used).cwiseProduct(scale_.head(used)) / rows_;
    const double total = squares_[target];
    const auto right = moments_.col(target).head(used);
    cholesky.solveInPlace(solution);
    solution = solution.cwiseProduct(scale_.head(used));
    const double left = std::max(total - solution.dot(right), 0.0);
    spread_[target] = std::sqrt(left / (rows_ - used));
  }
  return true;
}

double RunningRegression::standardError(int column, int target) const noexcept
{
  return spread_[target] * scale_[column] * std::sqrt(inverse_diagonal_[column] / fitted_rows_);
}
}  // namespace hjt
