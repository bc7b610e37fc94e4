// SPDX-License-Identifier: BSD-3-Clause
// Torsion of the gear under load, wave generator locked, as `joint_twin stiffness`.
// Usage: stiffness CONFIG_DIR [TORQUE...]    (torques at the output [N.m]; default 5 14 48)
#include <cstdlib>
#include <iostream>
#include <vector>

#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"

int main(int argc, char** argv)
try
{
  hjt::ParameterMap map;
  hjt::readDefaultConfiguration(argc > 1 ? argv[1] : "config", map);
  std::vector<double> torques;
  for (int i = 2; i < argc; ++i)
    torques.push_back(std::atof(argv[i]));
  if (torques.empty())
    torques = { 5.0, 14.0, 48.0 };

  // An output angle is negative: the load turns the output backwards.
  for (const hjt::StiffnessRow& row : hjt::analyseStiffness(hjt::parseParameters(map), 0.0, torques))
  {
    if (!row.status.ok())
    {
      std::cerr << row.torque << " N.m: " << hjt::explanationOf(row.status) << '\n';
      return 1;
    }
    std::cout << row.torque << " N.m: torsion " << 1e3 * row.output_angle << " mrad, " << row.teeth_loaded
              << " teeth loaded, hardest flank " << row.mesh_force_max << " N\n";
  }
  return 0;
}
catch (const hjt::InputError& error)
{
  std::cerr << error.what() << '\n';
  return 1;
}
