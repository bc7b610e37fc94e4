// SPDX-License-Identifier: BSD-3-Clause
// The loop of `joint_twin simulate` in C++ alone, for bench/python_speed.py: reads a number of steps a line from standard
// input and answers with the processor time that they took [s]. Arguments: directory of the default configuration,
// scene (full_ring or auto).
#include <ctime>
#include <iostream>

#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace
{
double processorTime()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
}  // namespace

int main(int argc, char** argv)
try
{
  if (argc != 3)
  {
    std::cerr << "usage: step_loop CONFIG_DIR full_ring|auto\n";
    return 2;
  }
  hjt::ParameterMap map;
  hjt::readDefaultConfiguration(argv[1], map);
  hjt::readAssignment(std::string("solver.scene=") + argv[2], map);
  hjt::Twin twin(hjt::parseParameters(map), { hjt::surfaceCacheDirectory() });
  twin.commandLoadTorque(0, 20.0);
  hjt::JointOutputs last;
  for (long steps = 0; std::cin >> steps;)
  {
    const double begin = processorTime();
    for (long step = 0; step < steps; ++step)
    {
      const hjt::Stamp instant = twin.stamp() + twin.stepLength();
      twin.commandMotorTorque(instant, 0.45);
      twin.step(instant);
      last = twin.outputs();
    }
    std::cout << processorTime() - begin << ' ' << last.motor_angle << std::endl;
  }
  return 0;
}
catch (const hjt::ParameterError& error)
{
  std::cerr << error.what() << '\n';
  return 1;
}
