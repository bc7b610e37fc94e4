// SPDX-License-Identifier: BSD-3-Clause
// Steps a twin for half a second under a constant motor torque; prints its sensors and the force on the hardest tooth.
// Usage: step_twin CONFIG_DIR    (the package's folder config)
#include <algorithm>
#include <cmath>
#include <iostream>

#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

int main(int argc, char** argv)
try
{
  hjt::ParameterMap map;
  hjt::readDefaultConfiguration(argc > 1 ? argv[1] : "config", map);
  hjt::readAssignment("output.load_inertia=1.5", map);  // as --set of the tool
  hjt::Twin twin(hjt::parseParameters(map));

  constexpr hjt::Stamp TENTH = 100'000'000;  // [ns]
  twin.commandMotorTorque(0, 0.5);           // at once [N.m]
  twin.commandLoadTorque(2 * TENTH, 20.0);   // after 0.2 s, at the output [N.m]
  hjt::ToothForces forces = twin.makeToothForces();
  for (hjt::Stamp until = TENTH; until <= 5 * TENTH; until += TENTH)
  {
    while (twin.step(until))
    {
    }
    if (!twin.toothForces(forces))
    {
      std::cerr << "no equilibrium of the teeth\n";
      return 1;
    }
    const double largest = *std::max_element(forces.mesh_force.begin(), forces.mesh_force.end(),
                                             [](double a, double b) { return std::abs(a) < std::abs(b); });
    std::cout << hjt::toSeconds(twin.stamp()) << " s: motor " << twin.encoders().motor_angle << " rad, output "
              << twin.encoders().output_angle << " rad, hardest tooth " << largest << " N, friction "
              << twin.outputs().friction_torque << " N.m\n";
  }
  return twin.outputs().converged ? 0 : 1;
}
catch (const hjt::InputError& error)  // key, value, unit and range
{
  std::cerr << error.what() << '\n';
  return 1;
}
