// SPDX-License-Identifier: BSD-3-Clause
// The loop of `joint_twin simulate` in C++ alone, for bench/python_speed.py. Reads lines with a number of steps, and
// every how many of them outputs and readings are kept; answers with the processor time that they took [s].
// Arguments: directory of the default configuration, scene (full_ring or auto).
#include <ctime>
#include <iostream>
#include <vector>

#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace
{
struct Row
{
  hjt::JointOutputs outputs;
  hjt::EncoderReadings encoders;
  double motor_torque{};  // as read [N.m]
};

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
  std::vector<Row> rows(10000);
  long every = 1;
  for (long steps = 0; std::cin >> steps >> every;)
  {
    std::size_t row = 0;
    const double begin = processorTime();
    for (long step = 0; step < steps; ++step)
    {
      const hjt::Stamp instant = twin.stamp() + twin.stepLength();
      twin.commandMotorTorque(instant, 0.45);
      twin.step(instant);
      if (step % every == every - 1)
      {
        rows[row] = { twin.outputs(), twin.encoders(), twin.motorTorqueReading() };
        row = row + 1 < rows.size() ? row + 1 : 0;
      }
    }
    std::cout << processorTime() - begin << ' ' << rows[0].outputs.motor_angle << std::endl;
  }
  return 0;
}
catch (const hjt::ParameterError& error)
{
  std::cerr << error.what() << '\n';
  return 1;
}
