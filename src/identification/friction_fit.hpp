// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/friction_map.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Gain, offset, inertia and friction of a joint from the rows that move: the most probable values after what is known
/// before (maximum a posteriori).
///
///   current = (load + J n^2 a + s (rest + P preload + G grease + F flanks + V n |w|)) / gain + offset
/// with the shares of FrictionMap, w the motor's speed, s its sign. Each row of the fit is the mean over BLOCK, in
/// which the ripple of the teeth cancels out; it counts by the deviation of the rows, outliers less (Huber), and by the
/// correlation of their residual. Known before is each value as configured, normally distributed with the deviation of
/// `known`: what a motion hardly shows stays near it, and others do not run away in its place. No friction can be
/// negative. A quantity whose deviation the motion does not halve is refused and stays as configured; the others are
/// fitted again; last with a Stribeck term, S n exp(-(w/v)^2), v motor.stribeck_velocity, which stays if its interval
/// does not hold zero.
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
  using Values = Eigen::Matrix<double, QUANTITIES, 1>;

  static constexpr double MOVING = 0.01;  ///< joint speed from which a row counts as moving [rad/s]
  static constexpr double BLOCK = 0.1;    ///< [s]

  /// `look` as in identify. @throws InputError if the samples hardly move.
  FrictionFit(const Parameters& parameters, const FrictionMap& friction, const std::vector<MotionSample>& samples,
              const std::function<void()>& look);

  double value(Quantity quantity) const { return values_[quantity]; }
  double halfWidth(Quantity quantity) const { return half_width_[quantity]; }  ///< of the 95 % interval; 0 if refused
  const std::string& refusal(Quantity quantity) const { return refusal_[quantity]; }  ///< empty: identified

private:
  /// Of a block: the torque at the joint by each quantity, at GAIN the known one [N.m], at OFFSET 1, and the current
  /// [A]. Times `factors` it is the residual.
  using Row = Eigen::Matrix<double, QUANTITIES + 1, 1>;

  static Row factors(const Values& values);
  static Eigen::Matrix<double, QUANTITIES + 1, QUANTITIES> slopes(const Values& values);
  void addBlocks(const Parameters& parameters, const FrictionMap& friction, const std::vector<MotionSample>& samples);
  void setKnown(const Parameters& parameters, const FrictionMap& friction);
  void solve(const std::function<void()>& look);
  void solveOnce(double deviation, double correlation_rows);
  double share(std::size_t quantity) const;

  Eigen::MatrixXd blocks_;    // a row each
  Eigen::MatrixXd products_;  // transposed times blocks
  Values values_ = Values::Zero();
  Values start_ = Values::Zero();       // as configured
  Values known_ = Values::Zero();       // its deviation
  Values half_width_ = Values::Zero();  // of the 95 % interval
  std::array<bool, QUANTITIES> asked_{};
  std::array<std::string, QUANTITIES> refusal_;
};
}  // namespace hjt
