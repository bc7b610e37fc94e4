// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "harmonic_joint_twin/health/tracked_lines.hpp"
#include "health/order_tracker.hpp"

namespace hjt
{
/// Slip of the wave generator's bearing over one window, by the lines of races and balls in the motor's ripple.
///
/// Law:   L(s) = sum_k |F_k(s)|^2 / n_k,   F_k(s) = sum w r exp(-j o_k(s) theta),   s* = argmax L(s), 0 <= s <= MOST
/// where  k       over lines;  w  weight
///        r       ripple less all that the window's fit makes of it but for these lines [rad]
///        theta   motor angle [rad];  o_k(s)  orders with slip s (trackedOrders)
///        n_k     of the noise about the line: median of |F_k|^2 over slips that no bearing has as well, over ln 2
/// s is 0 too where L of the kinematic error is larger by CLEARLY without slip.
/// Without a line that slips L is the sum of squares of noise, whose largest value over s passes L(0) by CLEARLY in
/// less than one window in 1000: s is then 0.
/// Source: bearings slip by 1 to 2 % (Randall and Antoni, Mech. Syst. Signal Process. 25, 2011, 485-520).
///
/// At an even speed none is looked for: sampling folds the lines of the teeth to sharp ones at any order there, two
/// apart as those of a race are.
///
/// Keeps every sample of a window: for recordings and data sets, not for a loop. A window of more than a million, or of
/// places more than 500 turns apart, has no slip looked for.
class BearingSlip
{
public:
  static constexpr double MOST = 0.03;  ///< [-]

  explicit BearingSlip(const Parameters& parameters);

  void reset() noexcept { samples_.clear(); }
  void add(const LineSample& sample)
  {
    if (samples_.size() <= MOST_SAMPLES)
    {
      samples_.push_back(sample);
    }
  }

  /// `fitted`: to the samples, without slip. 0: none stands out [-].
  double find(const OrderTracker& fitted) const;
  /// All lines fitted to the samples at the orders of a bearing with that slip, `angle_step` as OrderTracker::fit.
  OrderTracker refit(double slip, double angle_step) const;

private:
  static constexpr std::size_t MOST_SAMPLES = 1000000;

  struct BearingLine;
  std::vector<BearingLine> linesOf(const OrderTracker& fitted) const;

  GearParameters gear_;
  BearingParameters bearing_;
  double rated_torque_;  // [N.m]
  std::vector<LineSample> samples_;
};
}  // namespace hjt
