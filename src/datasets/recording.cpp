// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/recording.hpp"

#include <algorithm>

#include "base/text.hpp"

namespace hjt
{
namespace
{
/// The columns that a group names, which must be among `known`. @throws InputError with file and line.
std::vector<const RunColumn*> readColumns(const PlanNode& group, const std::vector<RunColumn>& known)
{
  std::vector<const RunColumn*> columns;
  const PlanNode& list = required(group, "columns", PlanNode::Kind::LIST);
  for (const auto& [key, element] : list.entries)
  {
    const std::string wanted = PlanValues().text(list, key);
    const auto column =
        std::find_if(known.begin(), known.end(), [&](const RunColumn& each) { return each.name == wanted; });
    if (column == known.end())
    {
      const auto name_of = [](const RunColumn& each) { return each.name; };
      element.refuse("is not a column; allowed: " + joined(known, ", ", name_of));
    }
    if (std::find(columns.begin(), columns.end(), &*column) != columns.end())
    {
      element.refuse("occurs twice");
    }
    columns.push_back(&*column);
  }
  return columns;
}
}  // namespace

const std::vector<RunColumn>& driveColumns()
{
  using I = const Instant&;
  static const std::vector<RunColumn> COLUMNS{
    // Quantities that a robot's controller can measure.
    { "motor_angle_encoder", "rad", "motor angle from its encoder", [](I i) { return i.encoders.motor_angle; } },
    { "motor_velocity_encoder", "rad/s", "motor speed from its encoder over sensors.velocity_window",
      [](I i) { return i.encoders.motor_velocity; } },
    { "output_angle_encoder", "rad", "unwrapped output angle from its encoder",
      [](I i) { return i.encoders.output_angle; } },
    { "output_velocity_encoder", "rad/s", "output speed from its encoder over sensors.velocity_window",
      [](I i) { return i.encoders.output_velocity; } },
    { "motor_torque_reading", "N.m", "motor torque estimated from the current",
      [](I i) { return i.motor_torque_reading; } },
    { "speed_reference", "rad/s", "reference of the joint speed", [](I i) { return i.speed_reference; } },
    // True values, which only the twin knows.
    { "motor_angle", "rad", "true angle of the motor", [](I i) { return i.outputs.motor_angle; } },
    { "motor_velocity", "rad/s", "true speed of the motor", [](I i) { return i.outputs.motor_velocity; } },
    { "output_angle", "rad", "true angle of the output", [](I i) { return i.outputs.output_angle; } },
    { "output_velocity", "rad/s", "true speed of the output", [](I i) { return i.outputs.output_velocity; } },
    { "motor_torque", "N.m", "torque applied by the motor", [](I i) { return i.outputs.motor_torque; } },
    { "load_torque", "N.m", "external torque at the output; > 0 resists positive motion",
      [](I i) { return i.outputs.load_torque; } },
    { "temperature", "degC", "temperature of the grease", [](I i) { return i.outputs.temperature; } },
    { "housing_temperature", "degC", "temperature of the housing", [](I i) { return i.outputs.housing_temperature; } },
    { "wave_generator_torque", "N.m", "torque of the wave generator on the flexspline",
      [](I i) { return i.outputs.wave_generator_torque; } },
    { "joint_torque", "N.m", "torque of the mesh on the circular spline", [](I i) { return i.outputs.joint_torque; } },
    { "friction_torque", "N.m", "torque at the motor whose power is that of all friction",
      [](I i) { return i.outputs.friction_torque; } },
    { "torsional_stiffness", "N.m/rad", "local stiffness with the wave generator locked",
      [](I i) { return i.outputs.torsional_stiffness; } },
    { "energy_residual", "J", "supplied energy less stored, dissipated and released energy",
      [](I i) { return i.outputs.energy_residual; } },
    { "wave_generator_force", "N", "force of the wave generator on each tooth", nullptr,
      &ToothForces::wave_generator_force },
    { "rim_tension", "N", "tension of the rim from each tooth to the next", nullptr, &ToothForces::rim_tension },
    { "bending_force", "N", "bending force of the segment from each tooth to the next", nullptr,
      &ToothForces::bending_force },
    { "mesh_force", "N", "normal force on the flank of each tooth; > 0 leading, < 0 trailing flank", nullptr,
      &ToothForces::mesh_force },
    { "tooth_x", "m", "x coordinate of each tooth point", nullptr, &ToothForces::tooth_x },
    { "tooth_y", "m", "y coordinate of each tooth point", nullptr, &ToothForces::tooth_y },
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

Recording readRecording(const PlanNode& record, bool of_arms)
{
  const PlanValues values;
  Recording recording;
  const std::string format = values.text(record, "format", "hdf5");
  if (format == "bag")
  {
    allowOnly(record, { "format" });
    recording.format = RunFormat::BAG;
    return recording;
  }
  if (format != "hdf5")
  {
    required(record, "format").refuse("is unknown; allowed: hdf5, bag");
  }
  if (!hasHdf5())
  {
    record.refuse("needs format: bag, because this build has no HDF5");
  }
  allowOnly(record, { "format", "start", "deflate", "indicators", "groups" });
  recording.indicators = values.flag(record, "indicators");
  if (recording.indicators && of_arms)
  {
    required(record, "indicators").refuse("are those of one drive; use `joint_twin indicators` for an arm");
  }
  const std::vector<RunColumn>& known = of_arms ? armColumns() : driveColumns();
  constexpr double START = 1.0;  // [s]
  constexpr int DEFLATE = 4;
  recording.start = values.number(record, "start", "s", { 0, 1e6 }, START);
  recording.deflate = static_cast<int>(values.whole(record, "deflate", "-", { 0, 9 }, DEFLATE));
  for (const auto& [name, node] : required(record, "groups", PlanNode::Kind::MAP).entries)
  {
    allowOnly(node, { "rate", "type", "columns" });
    RecordingGroup group{ name, values.number(node, "rate", "Hz", { 1e-3, 1e6 }), false, {} };
    const std::string type = values.text(node, "type", "float64");
    if (type != "float32" && type != "float64")
    {
      required(node, "type").refuse("is unknown; allowed: float32, float64");
    }
    group.float32 = type == "float32";
    group.columns = readColumns(node, known);
    if (name == "faults" || name == "parameters" || name == "indicators" || name == "record" ||
        name.find('/') != std::string::npos || group.columns.empty())
    {
      node.refuse(
          "needs at least one column, and a name other than faults, parameters, indicators and record, without '/'");
    }
    recording.groups.push_back(group);
  }
  return recording;
}
}  // namespace hjt
