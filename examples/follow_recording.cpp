// SPDX-License-Identifier: BSD-3-Clause
// Feeds the twin the torques of a recording row by row and prints measured and predicted output angle.
// Usage: follow_recording CONFIG_DIR FILE.csv    (rows: time [s], motor torque [N.m], load [N.m], output angle [rad])
#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

int main(int argc, char** argv)
try
{
  std::ifstream file(argc > 2 ? argv[2] : "");
  std::string line;
  if (!std::getline(file, line))  // the header
  {
    std::cerr << "usage: follow_recording CONFIG_DIR FILE.csv\n";
    return 2;
  }
  hjt::ParameterMap map;
  hjt::readDefaultConfiguration(argv[1], map);
  hjt::Twin twin(hjt::parseParameters(map));

  double sum = 0.0;
  int rows = 0;
  while (std::getline(file, line))
  {
    double time{}, motor_torque{}, load_torque{}, measured{};
    char comma{};
    std::istringstream(line) >> time >> comma >> motor_torque >> comma >> load_torque >> comma >> measured;
    const hjt::Stamp stamp = hjt::toStampLength(time);
    while (twin.step(stamp))  // up to this row with the torques of the rows before
    {
    }
    twin.commandMotorTorque(stamp, motor_torque);
    twin.commandLoadTorque(stamp, load_torque);
    const double predicted = twin.encoders().output_angle;
    std::cout << time << "," << measured << "," << predicted << '\n';
    sum += (measured - predicted) * (measured - predicted);
    ++rows;
  }
  std::cerr << rows << " rows, output angle off by " << (rows > 0 ? std::sqrt(sum / rows) : 0.0) << " rad rms\n";
  return twin.outputs().converged ? 0 : 1;
}
catch (const hjt::InputError& error)
{
  std::cerr << error.what() << '\n';
  return 1;
}
