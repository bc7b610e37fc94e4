// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include "studies/ring_stepper.hpp"

namespace hjt
{
/// Explicit Runge-Kutta method of order 8 in twelve stages, with embedded methods of order 5 and 3 to judge its error
/// by (Dormand and Prince 1989; DOP853 of Hairer, Norsett and Wanner).
///
/// For motions whose vibrations are wanted, every one of them: its step is bounded by the stiffest mode as that of
/// `ExplicitRingStepper` is (5.8 over its angular frequency), but up to there it is far more accurate. No allocation
/// after construction.
class DormandPrinceStepper : public EmbeddedRingStepper
{
public:
  explicit DormandPrinceStepper(DynamicRing& ring);

  /// False if a value ceased to be finite.
  bool step(RingMotion& motion, double length) noexcept override;

  bool attempt(RingMotion& motion, double length) noexcept override;
  void restart() noexcept override { begun_ = false; }
  void accept() noexcept override { begun_ = false; }
  int errorPower() const noexcept override { return 8; }

private:
  static constexpr int STAGES = 12;
  using Weights = std::array<double, STAGES>;

  void sum(const Eigen::VectorXd& start, const Weights& weights, double length, int stages,
           Eigen::VectorXd& out) noexcept;

  DynamicRing& ring_;
  bool begun_{};                               // the first stage is at hand
  std::array<Eigen::VectorXd, STAGES> rates_;  // of the states, per stage
  std::array<RingPower, STAGES> powers_;
  Eigen::VectorXd zero_;
  Eigen::VectorXd start_;  // states
  Eigen::VectorXd state_;
};
}  // namespace hjt
