// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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
  void add(double speed, double measured, double twin);

  std::vector<FrictionPoint> points() const;  ///< by speed, ascending

  /// Measured friction over the twin's, by the rows of all points; both ways count alike, so that a load that is wrong
  /// goes out. NaN: no point.
  double ratio() const;

private:
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
