// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "harmonic_joint_twin/model/joint_model.hpp"

namespace hjt
{
/// Teeth that are not as the parameters say, by number from 0 on.
struct ToothFaults
{
  std::vector<int> missing;  ///< broken off: no mesh force
  std::vector<int> cut;      ///< rim cut through behind the tooth: no tension, no bending
};

/// The joint with these faults. @throws ParameterError if there is no such tooth.
JointModel makeFaultyJoint(const Parameters& parameters, const ToothFaults& faults);
}  // namespace hjt
