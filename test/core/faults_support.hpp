// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "element_under_test.hpp"
#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "model/faults/joint_faults.hpp"
#include "random_ring.hpp"
#include "solver/ring_equilibrium.hpp"
#include "test_parameters.hpp"
#include "twin_runs.hpp"

namespace hjt
{
inline const std::vector<std::string> RUN{ "input.command_timeout=10.0" };

/// A place in the loaded lobe, where every kind shows.
inline int loadedPlace(FaultKind kind)
{
  return describe(kind).whole ? WHOLE_MEMBER : 0;
}

/// The ring of a gear with the faults that its parameters name, in equilibrium.
class StandingGear
{
public:
  explicit StandingGear(const Parameters& parameters)
    : faults_(parameters, allOf(parameters.faults)), ring_(faults_.model().ring, parameters.solver)
  {
    EXPECT_TRUE(ring_.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }).ok());
  }

  /// Wave generator at `angle` [rad], `torque` at the output [N.m].
  const RingEquilibrium& at(double angle, double torque)
  {
    EXPECT_TRUE(balanceOutput(ring_, angle, torque).ok());
    return ring_;
  }

private:
  static FaultList allOf(const std::vector<Fault>& faults)
  {
    FaultList list;
    for (const Fault& fault : faults)
    {
      list.set(fault, 0);
    }
    return list;
  }

  JointFaults faults_;
  RingEquilibrium ring_;
};
}  // namespace hjt
