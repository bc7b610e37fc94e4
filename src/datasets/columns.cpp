// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/columns.hpp"

namespace hjt
{
const std::vector<RunColumn>& driveColumns()
{
  using I = const Instant&;
  static const std::vector<RunColumn> COLUMNS{
    // Columns of a robot's controller.
    { "motor_angle_encoder", "rad", "motor encoder", [](I i) { return i.encoders.motor_angle; } },
    { "motor_velocity_encoder", "rad/s", "motor encoder, difference over sensors.velocity_window",
      [](I i) { return i.encoders.motor_velocity; } },
    { "output_angle_encoder", "rad", "output encoder, unwrapped", [](I i) { return i.encoders.output_angle; } },
    { "output_velocity_encoder", "rad/s", "output encoder, difference over sensors.velocity_window",
      [](I i) { return i.encoders.output_velocity; } },
    { "motor_torque_reading", "N.m", "motor torque estimated from the current",
      [](I i) { return i.motor_torque_reading; } },
    { "speed_reference", "rad/s", "reference of the joint speed", [](I i) { return i.speed_reference; } },
    // Columns of true values, which only the twin knows.
    { "motor_angle", "rad", "motor, true", [](I i) { return i.outputs.motor_angle; } },
    { "motor_velocity", "rad/s", "motor, true", [](I i) { return i.outputs.motor_velocity; } },
    { "output_angle", "rad", "output, true", [](I i) { return i.outputs.output_angle; } },
    { "output_velocity", "rad/s", "output, true", [](I i) { return i.outputs.output_velocity; } },
    { "motor_torque", "N.m", "applied by the motor", [](I i) { return i.outputs.motor_torque; } },
    { "load_torque", "N.m", "external, at the output; > 0 resists positive motion",
      [](I i) { return i.outputs.load_torque; } },
    { "temperature", "degC", "of the grease", [](I i) { return i.outputs.temperature; } },
    { "housing_temperature", "degC", "of the housing", [](I i) { return i.outputs.housing_temperature; } },
    { "wave_generator_torque", "N.m", "of the wave generator on the flexspline",
      [](I i) { return i.outputs.wave_generator_torque; } },
    { "joint_torque", "N.m", "of the mesh on the circular spline", [](I i) { return i.outputs.joint_torque; } },
    { "friction_torque", "N.m", "all friction, reduced to the motor by power",
      [](I i) { return i.outputs.friction_torque; } },
    { "torsional_stiffness", "N.m/rad", "local, wave generator locked",
      [](I i) { return i.outputs.torsional_stiffness; } },
    { "energy_residual", "J", "energy in, less stored, dissipated and released",
      [](I i) { return i.outputs.energy_residual; } },
    { "wave_generator_force", "N", "wave generator on each tooth", nullptr, &ToothForces::wave_generator_force },
    { "rim_tension", "N", "rim behind each tooth", nullptr, &ToothForces::rim_tension },
    { "bending_force", "N", "of the bent rim on each tooth", nullptr, &ToothForces::bending_force },
    { "mesh_force", "N", "flank of each tooth", nullptr, &ToothForces::mesh_force },
    { "tooth_x", "m", "position of each tooth", nullptr, &ToothForces::tooth_x },
    { "tooth_y", "m", "position of each tooth", nullptr, &ToothForces::tooth_y },
  };
  return COLUMNS;
}

const std::vector<RunColumn>& armColumns()
{
  static const std::vector<RunColumn> COLUMNS = []
  {
    std::vector<RunColumn> columns;
    for (const ArmQuantity& quantity : ARM_QUANTITIES)
    {
      columns.push_back({ quantity.name, quantity.unit, quantity.meaning, nullptr, nullptr, &quantity });
    }
    return columns;
  }();
  return COLUMNS;
}
}  // namespace hjt
