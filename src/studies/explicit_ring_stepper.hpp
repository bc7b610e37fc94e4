// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

#include "studies/ring_stepper.hpp"

namespace hjt
{
/// The classical Runge-Kutta method of Boost.odeint: no damping of its own worth speaking of, but the step is bounded
/// by the stiffest mode (2.8 over its angular frequency). The reference for the implicit methods.
class ExplicitRingStepper : public RingStepper
{
public:
  explicit ExplicitRingStepper(DynamicRing& ring);

  /// False if a value ceased to be finite.
  bool step(RingMotion& motion, double length) noexcept override;

private:
  using State = std::vector<double>;  // the ring's, energy supplied, energy dissipated

  DynamicRing& ring_;
  boost::numeric::odeint::runge_kutta4<State> method_;
  State state_;
};
}  // namespace hjt
