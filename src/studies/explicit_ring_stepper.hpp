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
  explicit ExplicitRingStepper(DynamicRing& ring) : ring_(ring), state_(static_cast<std::size_t>(ring.states()) + 2)
  {
    method_.adjust_size(state_);
  }

  /// False if a value ceased to be finite.
  bool step(RingMotion& motion, double length) noexcept override
  {
    const int n = ring_.coordinates();
    const int size = ring_.states();
    ring_.pairTeeth(motion.q, motion.time);
    Eigen::Map<Eigen::VectorXd>(state_.data(), n) = motion.q;
    Eigen::Map<Eigen::VectorXd>(state_.data() + n, n) = motion.v;
    double* ledger = state_.data() + size;
    ledger[0] = motion.supplied;
    ledger[1] = motion.dissipated;
    const auto system = [&](const State& state, State& derivative, double time)
    {
      ring_.rates(state.data(), time, derivative.data());
      derivative[static_cast<std::size_t>(size)] = ring_.power().supplied;
      derivative[static_cast<std::size_t>(size) + 1] = ring_.power().dissipated;
      ++counts_.force_evaluations;
    };
    method_.do_step(system, state_, motion.time, length);
    if (!Eigen::Map<const Eigen::VectorXd>(state_.data(), size + 2).allFinite())
    {
      return false;
    }
    motion.q = Eigen::Map<const Eigen::VectorXd>(state_.data(), n);
    motion.v = Eigen::Map<const Eigen::VectorXd>(state_.data() + n, n);
    motion.time += length;
    motion.supplied = ledger[0];
    motion.dissipated = ledger[1];
    ++counts_.steps;
    return true;
  }

private:
  using State = std::vector<double>;  // the ring's, energy supplied, energy dissipated

  DynamicRing& ring_;
  boost::numeric::odeint::runge_kutta4<State> method_;
  State state_;
};
}  // namespace hjt
