// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "studies/ring_stepper.hpp"

namespace hjt
{
/// Marches a dynamic ring in steps of its own choice, so that no tooth is further off by one step than the tolerance.
///
/// Proportional and integral control of the step's length (Gustafsson 1991; Hairer and Wanner IV.2):
///   next / present = 0.9 e_n^(-0.7 / k) e_(n-1)^(0.4 / k),   0.2 ... 5
/// where   e_n   error estimate of step n over the tolerance, at most 1; k   the power of the step it goes with
///
/// A step whose e_n is above 1 is done again, shorter, and the one after it does not grow. Where a tooth touches or
/// lets go the forces have a kink: no event is looked for, the estimate sees it and the step shrinks for as long as it
/// must. No allocation after construction.
class AdaptiveRingStepper : public RingStepper
{
public:
  /// `tolerance` > 0 [m].
  AdaptiveRingStepper(DynamicRing& ring, std::unique_ptr<EmbeddedRingStepper> method, double tolerance);

  /// Covers `length` in as many steps as it takes; what the last of them taught is kept for the next call. False if
  /// they became shorter than a billionth of it.
  bool step(RingMotion& motion, double length) noexcept override;

private:
  double firstStep(const RingMotion& motion, double length) noexcept;
  double growth(double ratio) noexcept;

  DynamicRing& ring_;
  std::unique_ptr<EmbeddedRingStepper> method_;
  double tolerance_;
  double next_{};           // step that the control asks for; 0: none yet [s]
  double previous_{ 1.0 };  // e of the last accepted step
  bool just_rejected_{};
  RingMotion begin_;
  RingMotion before_;
};
}  // namespace hjt
