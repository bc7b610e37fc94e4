// SPDX-License-Identifier: BSD-3-Clause
// A twin in a program of one's own. Argument: the directory of the default configuration.
#include <iostream>

#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

int main(int argc, char** argv)
try
{
  hjt::ParameterMap map;
  hjt::readDefaultConfiguration(argc > 1 ? argv[1] : ".", map);
  hjt::readAssignment("output.load_inertia=1.5", map);
  hjt::Twin twin(hjt::parseParameters(map));
  twin.commandMotorTorque(0, 0.5);
  while (twin.step(50'000'000))
  {
  }
  hjt::ToothForces forces = twin.makeToothForces();
  std::cout << "motor angle " << twin.outputs().motor_angle << " rad, teeth loaded " << twin.health().lobes.teeth_loaded
            << ", tooth forces " << twin.toothForces(forces) << '\n';
  return twin.outputs().converged && twin.outputs().motor_angle > 0.0 ? 0 : 1;
}
catch (const hjt::ParameterError& error)
{
  std::cerr << error.what() << '\n';
  return 1;
}
