// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/model/tooth_faults.hpp"

#include <string>

#include "harmonic_joint_twin/params/parameter_error.hpp"

namespace hjt
{
JointModel makeFaultyJoint(const Parameters& parameters, const ToothFaults& faults)
{
  const int teeth = parameters.gear.teeth_flexspline;
  for (const std::vector<int>* numbers : { &faults.missing, &faults.cut })
  {
    for (const int tooth : *numbers)
    {
      if (tooth < 0 || tooth >= teeth)
      {
        throw ParameterError("no tooth " + std::to_string(tooth) + " on this flexspline: 0 ... " +
                             std::to_string(teeth - 1));
      }
    }
  }
  JointModel joint(parameters);
  for (const int tooth : faults.missing)
  {
    joint.ring.mesh.stiffness()[tooth] = 0.0;
  }
  for (const int tooth : faults.cut)
  {
    joint.ring.tension.stiffness()[tooth] = 0.0;
    joint.ring.bending.stiffness()[tooth] = 0.0;
  }
  return joint;
}
}  // namespace hjt
