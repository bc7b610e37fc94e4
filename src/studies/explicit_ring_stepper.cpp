// SPDX-License-Identifier: BSD-3-Clause
#include "studies/explicit_ring_stepper.hpp"

#include <cmath>

namespace hjt
{
ExplicitRingStepper::ExplicitRingStepper(DynamicRing& ring)
  : ring_(ring), state_(static_cast<std::size_t>(ring.states()) + 2)
{
  method_.adjust_size(state_);
}

bool ExplicitRingStepper::step(RingMotion& motion, double length) noexcept
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
}  // namespace hjt
