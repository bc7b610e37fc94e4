// SPDX-License-Identifier: BSD-3-Clause
#include "identification/regression.hpp"

#include <algorithm>
#include <vector>

#include <ceres/crs_matrix.h>
#include <ceres/solver.h>
#include <Eigen/Cholesky>

#include "arm/residual_statistics.hpp"
#include "base/number_text.hpp"

namespace hjt
{
Eigen::VectorXd solve(ceres::Problem& problem, const std::vector<double*>& parameters, int most_iterations)
{
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = most_iterations;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  ceres::Problem::EvaluateOptions evaluate;
  evaluate.apply_loss_function = false;
  evaluate.parameter_blocks = parameters;
  std::vector<double> errors;
  ceres::CRSMatrix sparse;
  problem.Evaluate(evaluate, nullptr, &errors, nullptr, &sparse);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row)
  {
    for (int k = sparse.rows[row]; k < sparse.rows[row + 1]; ++k)
    {
      jacobian(row, sparse.cols[k]) = sparse.values[k];
    }
  }

  const Eigen::VectorXd residuals =
      Eigen::Map<Eigen::VectorXd>(errors.data(), static_cast<Eigen::Index>(errors.size()));
  const Eigen::VectorXd norm = jacobian.colwise().norm();
  const Eigen::VectorXd size = norm.unaryExpr([](double length) { return length > 0.0 ? length : 1.0; });
  const Eigen::Index n = jacobian.cols();
  const Eigen::MatrixXd scaled = jacobian * size.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd normal = scaled.transpose() * scaled + 1e-12 * Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd inverse = normal.ldlt().solve(Eigen::MatrixXd::Identity(n, n)).diagonal();
  const double variance = residuals.squaredNorm() / std::max(1.0, static_cast<double>(residuals.size() - n));
  return NORMAL_95 * (variance * correlationRows(residuals) * inverse).cwiseSqrt().cwiseQuotient(size);
}

std::string percentText(double share)
{
  return roundedText(100.0 * share, 2) + " %";
}
}  // namespace hjt
