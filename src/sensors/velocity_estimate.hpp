// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace hjt
{
/// Velocity as a drive takes it from an encoder: the difference of two angles over a fixed time.
///
/// Law:   v = (a_k - a_(k-n)) / (n T),  n = window / T rounded, at least 1
/// where  a_k  angle at the k-th sample     [rad]
///        T    time between two samples     [s]
/// Until n + 1 angles have come in, the difference is taken over what there is; with one angle the velocity is zero.
class VelocityEstimate
{
public:
  /// `window`, `period`: over which the difference is taken, between two samples [s].
  VelocityEstimate(double window, double period);

  void reset() noexcept;
  void update(double angle) noexcept;  ///< once every period [rad]
  double velocity() const noexcept;    ///< [rad/s]

private:
  double period_;
  std::vector<double> angles_;  // ring of n + 1
  std::size_t newest_{};
  std::size_t count_{};  // angles held
};
}  // namespace hjt
