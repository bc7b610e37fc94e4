// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace hjt
{
/// Friction at one speed, at the joint and against the motion: mean of the rows.
struct FrictionPoint
{
  double speed{};      ///< with its sign [rad/s]
  double measured{};   ///< [N.m]
  double deviation{};  ///< standard deviation of the measured rows [N.m]
  double twin{};       ///< the twin's at the same rows [N.m]
  std::uint64_t rows{};
};

/// Friction by speed, both ways apart, from rows of any number.
class FrictionPoints
{
public:
  static constexpr std::uint64_t MIN_ROWS = 30;  ///< points with fewer are not given

  /// `speed` with its sign [rad/s]; friction at the joint, against the motion > 0 [N.m].
  void add(double speed, double measured, double twin)
  {
    const double place = placeOf(speed);
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

  /// By speed, ascending
  std::vector<FrictionPoint> points() const
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

  /// Measured friction over the twin's, by the rows of all points; both ways count alike, so that a load that is wrong
  /// goes out. NaN: no point.
  double ratio() const { return ratio(points()); }

  /// The same over that of `reference`, at the speeds of both: the twin's friction need not rise with the speed as the
  /// joint's does. NaN: they have no speed in common.
  double ratioTo(const std::vector<FrictionPoint>& reference) const
  {
    std::vector<FrictionPoint> common;
    for (FrictionPoint point : points())
    {
      const auto other =
          std::find_if(reference.begin(), reference.end(),
                       [&](const FrictionPoint& candidate) { return isSameSpeed(candidate.speed, point.speed); });
      if (other != reference.end())
      {
        point.twin *= other->measured / other->twin;
        common.push_back(point);
      }
    }
    return ratio(common);
  }

private:
  static double ratio(const std::vector<FrictionPoint>& points)
  {
    double measured = 0.0;
    double twin = 0.0;
    for (const double way : { -1.0, 1.0 })
    {
      FrictionPoint sum;
      for (const FrictionPoint& point : points)
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

  static double placeOf(double speed) { return BINS_PER_DECADE * std::log10(std::abs(speed) / SLOWEST); }

  static bool isSameSpeed(double a, double b)
  {
    return std::signbit(a) == std::signbit(b) && std::abs(placeOf(a) - placeOf(b)) < 1.0;
  }

  struct Bin
  {
    std::uint64_t rows{};
    double speed{};
    double measured{};
    double squares{};
    double twin{};
  };
  static constexpr double SLOWEST = 0.01;  // [rad/s]
  static constexpr double BINS_PER_DECADE = 10.0;
  static constexpr std::size_t BINS = 30;  // up to 10 rad/s

  std::array<std::array<Bin, BINS>, 2> bins_{};
};
}  // namespace hjt
