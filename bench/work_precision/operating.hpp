// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "bench/work_precision/solvers.hpp"
#include "model/joint_model.hpp"
#include "solver/response_surface.hpp"

namespace hjt
{
/// The operating model: ring in equilibrium, joint of four states, from rest against 5 N.m, the motor's torque reversed
/// after 0.3 s; 1 s. Samples every 10 ms.
struct OperatingProblem
{
  /// With which friction.
  enum class Friction
  {
    /// The leapfrog takes friction as it is, set-valued at rest; for the other methods it is a steep slope there, over
    /// `solver.stiction_velocity`. That makes no difference in motion; but the cup's friction is left out.
    FOR_PEERS,
    AS_SHIPPED
  };
  explicit OperatingProblem(Friction friction);

  Parameters parameters;
  JointModel model;
  std::shared_ptr<const ResponseSurface> surface;
};

/// Ours and its peers on the joint's right-hand side. The problem must outlive them.
std::vector<Contender> operatingContenders(const OperatingProblem& problem);
std::vector<Contender> operatingReferences(const OperatingProblem& problem);

/// The levels of detail: full ring, table, and the table at angles read from the encoders.
std::vector<Contender> levelContenders(const OperatingProblem& problem);
std::vector<Contender> levelReferences(const OperatingProblem& problem);
}  // namespace hjt
