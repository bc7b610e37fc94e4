// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace hjt
{
/// By how much one signal of a stream lags behind another: where their cross-correlation is largest.
///
/// Both pass the same high-pass; products are summed for lags on a grid up to LONGEST to either side and forgotten over
/// MEMORY; a parabola through the largest three gives what lies between. Fixed memory; nothing allocates.
class DelayEstimate
{
public:
  static constexpr double LONGEST = 0.1;          ///< [s]
  static constexpr double GRID = 0.004;           ///< between lags tried [s]
  static constexpr double MEMORY = 20.0;          ///< [s]
  static constexpr double MIN_CORRELATION = 0.7;  ///< below it no delay is given [-]

  void reset() noexcept { *this = DelayEstimate(); }

  /// A row of both, later than the one before [s].
  void add(double time, double leading, double lagging) noexcept;

  /// Of the lagging signal, > 0: it comes later [s]. Nothing: too little alike, or the largest lies at the end.
  std::optional<double> lag() const noexcept;

private:
  static constexpr std::size_t ROOM = 512;
  static constexpr int HALF = 25;  // LONGEST / GRID
  static constexpr std::size_t LAGS = 2 * HALF + 1;
  static constexpr double SLOWEST = 0.5;  // time constant of the high-pass [s]

  struct Row
  {
    double time;
    double leading;
    double lagging;
  };
  const Row& at(std::uint64_t index) const noexcept { return rows_[index % ROOM]; }
  double correlation(std::size_t lag) const noexcept;

  std::array<Row, ROOM> rows_{};
  std::uint64_t begin_{};  // first row of the present stretch
  std::uint64_t end_{};
  double leading_mean_{};
  double lagging_mean_{};
  std::array<double, LAGS> products_{};
  std::array<double, LAGS> leading_power_{};
  double lagging_power_{};
  double seconds_{};  // that the sums hold
};
}  // namespace hjt
