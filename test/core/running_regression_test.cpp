// SPDX-License-Identifier: BSD-3-Clause
#include "health/running_regression.hpp"

#include <random>

#include <gtest/gtest.h>

namespace hjt
{
namespace
{
constexpr int COLUMNS = 4;
constexpr int ROWS = 40;
using Row = Eigen::Matrix<double, COLUMNS, 1>;
using Target = Eigen::Matrix<double, 1, 1>;

/// Rows at random and what they are weighted by, to be changed before they are added.
template <typename Change>
RunningRegression fitted(Change&& change)
{
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  RunningRegression regression(COLUMNS, 1);
  for (int i = 0; i < ROWS; ++i)
  {
    Row row;
    row << 1.0, normal(random), normal(random), normal(random);
    row[3] += 0.5 * row[1];
    const Target target(2.0 + row[1] - 3.0 * row[2] + 0.5 * row[3] + 0.1 * normal(random));
    change(regression, row, target);
  }
  return regression;
}

void expectAlike(RunningRegression one, RunningRegression other)
{
  ASSERT_TRUE(one.fit(COLUMNS));
  ASSERT_TRUE(other.fit(COLUMNS));
  for (int column = 0; column < COLUMNS; ++column)
  {
    EXPECT_NEAR(one.coefficient(column, 0), other.coefficient(column, 0), 1e-9) << column;
    EXPECT_NEAR(one.inflation(column), other.inflation(column), 1e-9) << column;
  }
}

TEST(RunningRegression, AWeightOfTwoIsARowAddedTwice)
{
  expectAlike(fitted([](RunningRegression& regression, const Row& row, const Target& target)
                     { regression.add(row, target, row[1] > 0.0 ? 2.0 : 1.0); }),
              fitted(
                  [](RunningRegression& regression, const Row& row, const Target& target)
                  {
                    regression.add(row, target);
                    if (row[1] > 0.0)
                    {
                      regression.add(row, target);
                    }
                  }));
}

TEST(RunningRegression, SubtractedAfterwardsIsAsSubtractedFromEveryRow)
{
  const auto plain = [](RunningRegression& regression, const Row& row, const Target& target)
  { regression.add(row, target, 1.0 + row[2] * row[2]); };
  RunningRegression afterwards = fitted(plain);
  afterwards.subtract(3, 1, 0.7);
  expectAlike(afterwards, fitted(
                              [](RunningRegression& regression, Row row, const Target& target)
                              {
                                const double weight = 1.0 + row[2] * row[2];
                                row[3] -= 0.7 * row[1];
                                regression.add(row, target, weight);
                              }));
}

TEST(RunningRegression, ADroppedColumnIsAsOneOfZeros)
{
  RunningRegression afterwards =
      fitted([](RunningRegression& regression, const Row& row, const Target& target) { regression.add(row, target); });
  afterwards.drop(2);
  expectAlike(afterwards, fitted(
                              [](RunningRegression& regression, Row row, const Target& target)
                              {
                                row[2] = 0.0;
                                regression.add(row, target);
                              }));
  EXPECT_EQ(afterwards.fit(COLUMNS), true);
  EXPECT_EQ(afterwards.coefficient(2, 0), 0.0);
}

TEST(RunningRegression, MeanIsWeighted)
{
  RunningRegression regression(2, 1);
  regression.add(Eigen::Vector2d(1.0, 4.0), Target(0.0), 3.0);
  regression.add(Eigen::Vector2d(1.0, 8.0), Target(0.0), 1.0);
  EXPECT_DOUBLE_EQ(regression.mean(1, 0), 5.0);
  EXPECT_DOUBLE_EQ(regression.mean(0, 1), 5.0);
  EXPECT_DOUBLE_EQ(regression.mean(1, 1), 28.0);
}
}  // namespace
}  // namespace hjt
