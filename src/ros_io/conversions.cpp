// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/ros_io/conversions.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "harmonic_joint_twin/ros_io/time.hpp"

namespace hjt
{
namespace
{
constexpr std::size_t MOTOR = 0;
constexpr std::size_t JOINT = 1;

// The arrays were sized by makeContactForces; a shorter source leaves the rest of the target as it was.
void copyArray(const std::vector<double>& from, std::vector<double>& to) noexcept
{
  std::copy_n(from.begin(), std::min(from.size(), to.size()), to.begin());
}

EffortStatus readEffort(const sensor_msgs::JointState& message, const std::string& name, double& effort) noexcept
{
  const auto found = std::find(message.name.begin(), message.name.end(), name);
  if (found == message.name.end())
  {
    return EffortStatus::UNKNOWN_JOINT;
  }
  const auto index = static_cast<std::size_t>(found - message.name.begin());
  if (index >= message.effort.size())
  {
    return EffortStatus::MISSING_EFFORT;
  }
  effort = message.effort[index];
  return EffortStatus::FOUND;
}
}  // namespace

sensor_msgs::JointState makeJointStates(const JointNames& names)
{
  sensor_msgs::JointState message;
  message.header.frame_id = names.joint;
  message.name = { names.motor, names.joint };
  message.position.resize(2);
  message.velocity.resize(2);
  message.effort.resize(2);
  return message;
}

void fillJointStates(const JointOutputs& outputs, const EncoderReadings& readings,
                     sensor_msgs::JointState& message) noexcept
{
  message.header.stamp = toRosTime(outputs.stamp);
  message.position[MOTOR] = readings.motor_angle;
  message.position[JOINT] = readings.output_angle;
  message.velocity[MOTOR] = readings.motor_velocity;
  message.velocity[JOINT] = readings.output_velocity;
  message.effort[MOTOR] = outputs.motor_torque;
  message.effort[JOINT] = outputs.joint_torque;
}

harmonic_joint_twin::Encoders makeEncoders(const JointNames& names)
{
  harmonic_joint_twin::Encoders message;
  message.header.frame_id = names.joint;
  return message;
}

void fillEncoders(const JointOutputs& outputs, const EncoderReadings& readings,
                  harmonic_joint_twin::Encoders& message) noexcept
{
  message.header.stamp = toRosTime(outputs.stamp);
  message.motor_count = readings.motor_count;
  message.motor_angle = readings.motor_angle;
  message.motor_angle_true = outputs.motor_angle;
  message.output_count = readings.output_count;
  message.output_angle = readings.output_angle;
  message.output_angle_true = outputs.output_angle;
}

harmonic_joint_twin::ContactForces makeContactForces(const JointNames& names, int teeth)
{
  harmonic_joint_twin::ContactForces message;
  message.header.frame_id = names.joint;
  const auto size = static_cast<std::size_t>(teeth);
  for (auto* array : { &message.wave_generator_force, &message.rim_tension, &message.bending_force, &message.mesh_force,
                       &message.tooth_x, &message.tooth_y })
  {
    array->resize(size);
  }
  return message;
}

void fillContactForces(const JointOutputs& outputs, const ToothForces& forces,
                       harmonic_joint_twin::ContactForces& message) noexcept
{
  message.header.stamp = toRosTime(outputs.stamp);
  message.wave_generator_angle = outputs.motor_angle;
  message.output_angle = outputs.output_angle;
  copyArray(forces.wave_generator_force, message.wave_generator_force);
  copyArray(forces.rim_tension, message.rim_tension);
  copyArray(forces.bending_force, message.bending_force);
  copyArray(forces.mesh_force, message.mesh_force);
  copyArray(forces.tooth_x, message.tooth_x);
  copyArray(forces.tooth_y, message.tooth_y);
}

harmonic_joint_twin::Health makeHealth(const JointNames& names)
{
  harmonic_joint_twin::Health message;
  message.header.frame_id = names.joint;
  return message;
}

void fillHealth(const JointOutputs& outputs, const HealthReport& report, harmonic_joint_twin::Health& message) noexcept
{
  message.header.stamp = toRosTime(outputs.stamp);
  message.transmission_ratio_valid = report.transmission_ratio_valid;
  message.transmission_ratio = report.transmission_ratio;
  message.torsion = report.torsion;
  message.torsional_stiffness_valid = report.torsional_stiffness_valid;
  message.torsional_stiffness = report.torsional_stiffness;
  message.torsional_stiffness_model = report.torsional_stiffness_model;
  message.teeth_loaded = report.teeth_loaded;
  std::copy(report.lobe_mesh_force.begin(), report.lobe_mesh_force.end(), message.lobe_mesh_force.begin());
  message.lobe_asymmetry = report.lobe_asymmetry;
  message.wave_generator_load = report.wave_generator_load;
  message.friction_torque = report.friction_torque;
  message.efficiency_valid = report.efficiency_valid;
  message.efficiency = report.efficiency;
  message.kinematic_error_valid = report.kinematic_error_valid;
  message.kinematic_error = report.kinematic_error;
  message.motor_torque = report.motor_torque;
  message.joint_torque = report.joint_torque;
  message.energy_residual = report.energy_residual;
  message.solver_state = static_cast<std::uint8_t>(report.solver_state);
  message.solver_iterations = report.solver_iterations;
  message.solver_residual = report.solver_residual;
  message.solver_failures = report.solver_failures;
}

harmonic_joint_twin::Faults makeFaults(const JointNames& names, Stamp stamp, const FaultList& faults)
{
  harmonic_joint_twin::Faults message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = names.joint;
  for (const ActiveFault& active : faults)
  {
    harmonic_joint_twin::Fault fault;
    fault.header = message.header;
    fault.header.stamp = fault.since = toRosTime(active.since);
    fault.kind = describe(active.fault.kind).name;
    fault.severity = active.fault.severity;
    fault.place = active.fault.place;
    message.faults.push_back(fault);
  }
  return message;
}

std::string readFault(const harmonic_joint_twin::Fault& message, const Parameters& parameters, Fault& fault)
{
  const std::optional<FaultKind> kind = faultNamed(message.kind);
  if (!kind)
  {
    return "kind = '" + message.kind + "' is unknown, allowed: " + faultNames();
  }
  fault = { *kind, message.severity, message.place, 0.0 };
  return faultErrors(fault, parameters, "");
}

EffortStatus readMotorTorque(const sensor_msgs::JointState& message, const JointNames& names, double& torque) noexcept
{
  const EffortStatus status = readEffort(message, names.joint, torque);
  return status == EffortStatus::UNKNOWN_JOINT ? readEffort(message, names.motor, torque) : status;
}

EffortStatus readLoadTorque(const sensor_msgs::JointState& message, const JointNames& names, double& torque) noexcept
{
  return readEffort(message, names.joint, torque);
}
}  // namespace hjt
