// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include <gtest/gtest.h>

#include "identification/torque_fit.hpp"

namespace hjt
{
namespace
{
/// By the products of the definition.
double directRows(const Eigen::VectorXd& residuals)
{
  const Eigen::Index rows = residuals.size();
  double length = 1.0;
  for (Eigen::Index lag = 1; lag < rows / 4; ++lag)
  {
    const double product = residuals.head(rows - lag).dot(residuals.tail(rows - lag));
    if (product <= 0.0)
    {
      break;
    }
    length += 2.0 * product / residuals.squaredNorm();
  }
  return length;
}
}  // namespace

TEST(CorrelationRows, AreThoseOfTheDefinition)
{
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  for (const double memory : { 0.0, 0.5, 0.95, 0.999 })
  {
    for (const Eigen::Index rows : { 5, 100, 1000, 3001 })
    {
      Eigen::VectorXd residuals(rows);
      double last = 0.0;
      for (double& residual : residuals)
      {
        residual = last = memory * last + normal(engine);
      }
      EXPECT_NEAR(correlationRows(residuals), directRows(residuals), 1e-9 * directRows(residuals)) << memory;
    }
  }
  EXPECT_EQ(correlationRows(Eigen::VectorXd::Zero(100)), 1.0);
}

/// A product for each lag of half an hour at 125 Hz would take a minute.
TEST(CorrelationRows, TakeMuchLessThanTheDefinitionWhereAllRowsAreAlike)
{
  constexpr Eigen::Index ROWS = 225'000;
  EXPECT_NEAR(correlationRows(Eigen::VectorXd::Ones(ROWS)), 1.0 + 2.0 * ROWS / 4.0 * 7.0 / 8.0, 2.0);
}
}  // namespace hjt
