// SPDX-License-Identifier: BSD-3-Clause
#include "health/running_regression.hpp"
#include "test/support/seeded_random.hpp"

#include <functional>

namespace hjt
{
namespace
{
constexpr int COLUMNS = 4;
constexpr int ROWS = 40;
using Row = Eigen::Matrix<double, COLUMNS, 1>;
using Target = Eigen::Matrix<double, 1, 1>;

/// Rows at random and what they are weighted by, to be changed before they are added.
RunningRegression fitted(const std::function<void(RunningRegression& to, Row row, const Target& target)>& add)
{
  SeededRandom random(11);
  RunningRegression regression(COLUMNS, 1);
  for (int i = 0; i < ROWS; ++i)
  {
    Row row;
    row << 1.0, random.normal(), random.normal(), random.normal();
    row[3] += 0.5 * row[1];
    const Target target(2.0 + row[1] - 3.0 * row[2] + 0.5 * row[3] + 0.1 * random.normal());
    add(regression, row, target);
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
  const RunningRegression weighted = fitted([](RunningRegression& to, const Row& row, const Target& target)
                                            { to.add(row, target, row[1] > 0.0 ? 2.0 : 1.0); });
  const RunningRegression twice = fitted(
      [](RunningRegression& to, const Row& row, const Target& target)
      {
        for (int k = 0; k < (row[1] > 0.0 ? 2 : 1); ++k)
        {
          to.add(row, target);
        }
      });
  expectAlike(weighted, twice);
}

/// A column that is dropped, or subtracted from by a factor, afterwards or in every row.
TEST(RunningRegression, ChangedAfterwardsIsAsChangedInEveryRow)
{
  const auto changed = [](double factor, bool is_dropped)
  {
    return fitted(
        [=](RunningRegression& to, Row row, const Target& target)
        {
          const double weight = 1.0 + row[2] * row[2];
          row[3] -= factor * row[1];
          row[2] = is_dropped ? 0.0 : row[2];
          to.add(row, target, weight);
        });
  };
  RunningRegression subtracted = changed(0.0, false);
  subtracted.subtract(3, 1, 0.7);
  expectAlike(subtracted, changed(0.7, false));
  RunningRegression dropped = changed(0.0, false);
  dropped.drop(2);
  expectAlike(dropped, changed(0.0, true));
  EXPECT_TRUE(dropped.fit(COLUMNS));
  EXPECT_EQ(dropped.coefficient(2, 0), 0.0);
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
