// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/friction_map.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Gain, offset, inertia and friction of a joint from the rows that move, by least squares (Ceres).
///
///   current = (load + J n^2 a + s (rest + P preload + G grease + F flanks + V n |w|)) / gain + offset
/// with the shares of FrictionMap, w the motor's speed, s its sign. Each row of the fit is the mean over BLOCK, in
/// which the ripple of the teeth cancels out. No friction can be negative: preload and grease are held at zero then.
/// Parameters that the data do not identify are dropped one at a time: first the optional ones (viscous friction in
/// addition to the grease's, more friction of the flanks), then those with a known default (offset, gain, inertia). A
/// Stribeck term, S n exp(-(w/5)^2), is fitted in addition.
class FrictionFit
{
public:
  enum Quantity
  {
    GAIN,      ///< its inverse [A/(N.m)]
    OFFSET,    ///< [A]
    INERTIA,   ///< of the motor, less what the load holds [kg.m^2]
    PRELOAD,   ///< [N]
    GREASE,    ///< of the configured [-]
    FLANKS,    ///< of the configured [-]
    VISCOUS,   ///< at the motor [N.m.s/rad]
    STRIBECK,  ///< at the motor [N.m]
    QUANTITIES
  };
  using Values = std::array<double, QUANTITIES>;

  static constexpr double MOVING = 0.01;  ///< joint speed from which a row counts as moving [rad/s]
  static constexpr double BLOCK = 0.1;    ///< [s]

  /// @throws InputError if the samples hardly move.
  FrictionFit(const Parameters& parameters, const FrictionMap& friction, const std::vector<MotionSample>& samples);

  double value(Quantity quantity) const { return values_[quantity]; }
  double halfWidth(Quantity quantity) const { return half_width_[quantity]; }  ///< of the 95 % interval; 0 if refused
  const std::string& refusal(Quantity quantity) const { return refusal_[quantity]; }  ///< empty: identified

private:
  struct Block
  {
    double current;
    double known;   // torque at the joint that nothing is asked of [N.m]
    Values column;  // torque at the joint by each quantity; gain and offset unused
  };
  struct Residual;
  struct Verdict
  {
    double badness{};    // 0: sound; else above 1
    std::string reason;  // empty: sound
  };

  void addBlocks(const Parameters& parameters, const FrictionMap& friction, const std::vector<MotionSample>& samples);
  double deviation() const;
  void solve();
  Verdict whyRefused(std::size_t quantity) const;
  bool refuseWorst();

  std::vector<Block> blocks_;
  Values values_{};
  Values start_{};
  Values half_width_{};
  Values norm_{};
  Values tolerance_{};
  std::array<bool, QUANTITIES> asked_{};
  std::array<std::string, QUANTITIES> refusal_;
};
}  // namespace hjt
