// SPDX-License-Identifier: BSD-3-Clause
#include "apps/compare/friction_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hjt
{
void FrictionPoints::add(double speed, double measured, double twin)
{
  const double place = BINS_PER_DECADE * std::log10(std::abs(speed) / SLOWEST);
  if (!(place >= 0.0 && place < static_cast<double>(BINS)))
  {
    return;
  }
  Bin& bin = bins_[speed < 0.0 ? 0 : 1][static_cast<std::size_t>(place)];
  ++bin.rows;
  bin.speed += speed;
  bin.measured += measured;
  bin.squares += measured * measured;
  bin.twin += twin;
}

std::vector<FrictionPoint> FrictionPoints::points() const
{
  std::vector<FrictionPoint> points;
  for (const auto& way : bins_)
  {
    for (const Bin& bin : way)
    {
      if (bin.rows >= MIN_ROWS)
      {
        const auto n = static_cast<double>(bin.rows);
        const double mean = bin.measured / n;
        const double deviation = std::sqrt(std::max(0.0, bin.squares / n - mean * mean));
        points.push_back({ bin.speed / n, mean, deviation, bin.twin / n, bin.rows });
      }
    }
  }
  std::sort(points.begin(), points.end(),
            [](const FrictionPoint& a, const FrictionPoint& b) { return a.speed < b.speed; });
  return points;
}

double FrictionPoints::ratio() const
{
  double measured = 0.0;
  double twin = 0.0;
  for (const double way : { -1.0, 1.0 })
  {
    FrictionPoint sum;
    for (const FrictionPoint& point : points())
    {
      if (way * point.speed > 0.0)
      {
        const auto rows = static_cast<double>(point.rows);
        sum.rows += point.rows;
        sum.measured += rows * point.measured;
        sum.twin += rows * point.twin;
      }
    }
    if (sum.rows > 0)
    {
      measured += sum.measured / static_cast<double>(sum.rows);
      twin += sum.twin / static_cast<double>(sum.rows);
    }
  }
  return twin > 0.0 ? measured / twin : std::numeric_limits<double>::quiet_NaN();
}
}  // namespace hjt
