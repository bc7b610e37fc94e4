// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <Eigen/Core>

namespace hjt
{
/// A cost near some values: that of the model which is linear there, its slopes and its curvature.
struct NormalEquations
{
  double cost{};
  Eigen::VectorXd gradient;
  Eigen::MatrixXd normal;
};

/// Of errors that are linear in some columns, those beyond `outlier` counting by their size alone (Huber).
/// `products`: transposed columns times columns.
NormalEquations huberEquations(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns, Eigen::MatrixXd products,
                               double outlier);

/// Values of least cost between bounds, from these on (Levenberg and Marquardt). Equal bounds hold a value.
Eigen::VectorXd leastCost(const Eigen::VectorXd& start, const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest,
                          const std::function<NormalEquations(const Eigen::VectorXd& values)>& equations);

/// Half widths of the 95 % intervals of what the columns belong to, widened by the errors' correlation; rows in the
/// order of time. 0 of a column that is zero.
Eigen::VectorXd halfWidths(const Eigen::VectorXd& errors, const Eigen::MatrixXd& columns);
}  // namespace hjt
