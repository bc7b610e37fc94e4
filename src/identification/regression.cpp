// SPDX-License-Identifier: BSD-3-Clause
#include "identification/regression.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "arm/residual_statistics.hpp"

namespace hjt
{
NormalEquations huberEquations(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns, Eigen::MatrixXd products,
                               double outlier)
{
  const Eigen::VectorXd counted = errors.cwiseMax(-outlier).cwiseMin(outlier);
  for (Eigen::Index i = 0; i < errors.size(); ++i)
  {
    if (counted[i] != errors[i])
    {
      products.noalias() -= columns.row(i).transpose() * columns.row(i);
    }
  }
  return { counted.dot(errors - 0.5 * counted), columns.transpose() * counted, products };
}

Eigen::VectorXd leastCost(const Eigen::VectorXd& start, const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest,
                          const std::function<NormalEquations(const Eigen::VectorXd& values)>& equations)
{
  constexpr int MOST_STEPS = 100;
  constexpr double SMALL = 1e-9;  // change of the cost over it
  Eigen::VectorXd values = start.cwiseMax(lowest).cwiseMin(highest);
  NormalEquations here = equations(values);
  double damping = 1e-4;
  double change = here.cost;
  for (int step = 0; step < MOST_STEPS && std::abs(change) > SMALL * here.cost; ++step)
  {
    for (Eigen::Index i = 0; i < values.size(); ++i)
    {
      // A value at its bound stays there while the cost falls beyond it.
      if (here.gradient[i] > 0.0 ? values[i] <= lowest[i] : values[i] >= highest[i])
      {
        here.normal.row(i).setZero();
        here.normal.col(i).setZero();
        here.normal(i, i) = 1.0;
        here.gradient[i] = 0.0;
      }
    }
    Eigen::MatrixXd damped = here.normal;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::VectorXd there = (values - damped.ldlt().solve(here.gradient)).cwiseMax(lowest).cwiseMin(highest);
    NormalEquations next = equations(there);
    change = here.cost - next.cost;
    damping *= change > 0.0 ? 0.1 : 10.0;
    if (change > 0.0)
    {
      values = there;
      here = std::move(next);
    }
  }
  return values;
}

Eigen::VectorXd halfWidths(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns)
{
  const Eigen::VectorXd norm = columns.colwise().norm();
  const Eigen::VectorXd size = norm.unaryExpr([](double length) { return length > 0.0 ? length : 1.0; });
  const Eigen::Index n = columns.cols();
  const Eigen::MatrixXd scaled = columns * size.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd normal = scaled.transpose() * scaled + 1e-12 * Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd inverse = normal.ldlt().solve(Eigen::MatrixXd::Identity(n, n)).diagonal();
  const Eigen::Index asked = (norm.array() > 0.0).count();
  const double variance = errors.squaredNorm() / std::max(1.0, static_cast<double>(errors.size() - asked));
  return (norm.array() > 0.0)
      .select(NORMAL_95 * (variance * correlationRows(errors) * inverse).cwiseSqrt().cwiseQuotient(size), 0.0);
}
}  // namespace hjt
