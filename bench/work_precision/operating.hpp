// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "bench/work_precision/solvers.hpp"
#include "model/joint_model.hpp"

namespace hjt
{
/// The operating model: ring in equilibrium, joint of four states, from rest against 5 N.m, the motor's torque reversed
/// after 0.3 s; 1 s.
///
/// The leapfrog takes friction as it is, set-valued at rest; for the other methods it is a steep slope there, over
/// `solver.stiction_velocity`. That makes no difference in motion; but the cup's dry friction sticks most of the time,
/// in motion too, and is left out.
struct OperatingProblem
{
  OperatingProblem();

  Parameters parameters;
  JointModel model;
};

/// Ours and its peers on the joint's right-hand side. The problem must outlive them.
std::vector<Contender> operatingContenders(const OperatingProblem& problem);
std::vector<Contender> operatingReferences(const OperatingProblem& problem);
}  // namespace hjt
